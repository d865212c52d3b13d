/* The command: one function per subcommand. Each parses argv (argv[0] is its own name), does its
 * work and returns the exit status; a message of turner_fail is printed by main. */
#ifndef TURNER_APP_APP_H
#define TURNER_APP_APP_H

#include "base/result.h"
#include "turner.h"

enum turner_result turner_cmd_render(int argc, char **argv);
enum turner_result turner_cmd_compare(int argc, char **argv);
enum turner_result turner_cmd_compare_shaders(int argc, char **argv);
enum turner_result turner_cmd_check(int argc, char **argv);
enum turner_result turner_cmd_chart(int argc, char **argv);
enum turner_result turner_cmd_explain(int argc, char **argv);
enum turner_result turner_cmd_devices(int argc, char **argv);
enum turner_result turner_cmd_params(int argc, char **argv);
enum turner_result turner_cmd_stability(int argc, char **argv);
enum turner_result turner_cmd_export(int argc, char **argv);
enum turner_result turner_cmd_bench(int argc, char **argv);
enum turner_result turner_cmd_view(int argc, char **argv);

/* What a subcommand says of an option getopt_long did not understand: TURNER_USAGE naming the
 * nearest way out ("turner render --help"). `argv[optind-1]` is the culprit. */
enum turner_result turner_bad_option(char **argv);

/* Numbers in options: whole text, range checked; TURNER_USAGE names the option and the range. */
enum turner_result turner_option_int(int *out, const char *option, const char *text, int least,
                                     int most);
enum turner_result turner_option_real(double *out, const char *option, const char *text,
                                      double least, double most);
/* WIDTHxHEIGHT */
enum turner_result turner_option_size(int *width, int *height, const char *option,
                                      const char *text);
/* The index of `text` in a NULL-terminated list of choices; the message lists them. */
enum turner_result turner_option_choice(int *out, const char *option, const char *text,
                                        const char *const *choices);

/* ---- progress bar on stderr, when that is a terminal and not quiet ---- */
struct turner_progress_bar {
    bool on;
    double start, shown; /* seconds */
    const char *what;    /* what runs now, shown after the figures; NULL: nothing */
};
void turner_progress_begin(struct turner_progress_bar *bar, bool quiet);
/* For turner_render_options.progress; `user` is the bar. */
bool turner_progress_show(double share, void *user);
void turner_progress_end(struct turner_progress_bar *bar);

/* Writes statistics and settings as JSON, whole or not at all; `path` "-" is stdout. */
enum turner_result turner_statistics_write(const char *path, const struct turner_scene *scene,
                                           const struct turner_statistics *statistics);

/* Writes a picture with its settings, version and device as metadata; `layers` may be NULL. */
enum turner_result turner_picture_write(const char *path, const struct turner_scene *scene,
                                        const struct turner_image *image,
                                        const struct turner_statistics *statistics,
                                        const struct turner_layers *layers);

/* The scene's settings as they will be used, as the JSON of a "settings" object (free). */
char *turner_settings_json(const struct turner_scene *scene);

#endif
