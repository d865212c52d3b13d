/* Reads the scene named and says which turner did it. */
#include <stdio.h>
#include <turner.h>

int main(int argc, char **argv)
{
    struct turner_scene *scene = NULL;
    enum turner_result result = turner_scene_load(&scene, argc > 1 ? argv[1] : "");
    turner_scene_destroy(scene);
    if (result == TURNER_OK)
        printf("turner %s\n", turner_version());
    else
        fprintf(stderr, "consumer: %s\n", turner_message());
    return result;
}
