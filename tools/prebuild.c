/* turner_prebuild OUTPUT.c: compiles the kernel that pictures are drawn with on Mesa's CPU device, into
 * the source of an array of its SPIR-V (src/gpu/prebuilt.h). Run when turner is built. */
#include <inttypes.h>
#include <stdio.h>

#include "gpu/cached.h"

static int fail(const char *message)
{
    fprintf(stderr, "turner_prebuild: %s\n", message);
    return 1;
}

int main(int argc, char **argv)
{
    static const char *const defines[] = {"TURNER_PACKET"};
    struct turner_shader_source source;
    struct turner_spirv spirv;
    if (argc != 2)
        return fail("say where the source goes");
    if (turner_shader_source_create(&source, "render.comp", NULL, 0) != TURNER_OK ||
        turner_compile(&spirv, &source, defines, 1) != TURNER_OK)
        return fail(turner_message());
    FILE *file = fopen(argv[1], "w");
    if (!file)
        return fail("its source cannot be written");
    fprintf(file, "/* Made by tools/prebuild.c. */\n#include \"gpu/prebuilt.h\"\n\n"
                  "static const uint32_t words[] = {");
    for (size_t i = 0; i < spirv.count; i++)
        fprintf(file, "%s0x%" PRIx32 ",", i % 10 == 0 ? "\n" : "", spirv.words[i]);
    fprintf(file, "\n};\nconst struct turner_prebuilt turner_prebuilt = {0x%" PRIx64 "u, %zu, words};\n",
            turner_compile_key(&source, defines, 1), spirv.count);
    turner_spirv_destroy(&spirv);
    turner_shader_source_destroy(&source);
    return fclose(file) == 0 ? 0 : fail("its source cannot be written");
}
