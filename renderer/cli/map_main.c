/* map_main.c: the program afterglow-map: what a kept photon map holds; maps filled on different machines, put together.
 * Flow: argv -> the public interface. Threads: main alone. */
#include "afterglow/afterglow.h"
#include "status.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char HELP[] =
    "usage: afterglow-map info FILE...\n"
    "       afterglow-map merge OUT FILE...\n"
    "Photon maps that afterglow --photon-map has kept.\n"
    "\n"
    "  info          what files hold: for which scene, program and machine, with which settings, how full\n"
    "  merge         put the irradiances of files of one map together, which were filled apart: in any order, and any\n"
    "                number of times; OUT is one of them where it is there\n"
    "  --help        print this\n"
    "  --version     print the version\n"
    "\n"
    "Exit status: 0 all is well; 1 a file cannot be read, is no photon map, or is another one; 2 the command line has an\n"
    "error; 3 the system failed.\n";

static void say(void *user, ag_log_level level, const char *text)
{
    (void)user;
    if (level <= AG_LOG_WARNING)
        fprintf(stderr, "afterglow-map: %s\n", text);
}

static int exit_code(ag_status status)
{
    return status == AG_OK ? 0 : status == AG_ERROR_INPUT ? 1 : status == AG_ERROR_ARGUMENT ? 2 : 3;
}

static void print_filling(const ag_photon_map_info *info)
{
    printf("irradiances: %" PRIu64 " of %" PRIu64 " computed (%.1f %%)\n", info->ready, info->irradiance_photons,
           info->irradiance_photons > 0 ? 100.0 * (double)info->ready / (double)info->irradiance_photons : 100.0);
}

static void print_info(const char *path, const ag_photon_map_info *info)
{
    printf("file: %s\nbytes: %" PRIu64 "\n", path, info->file_bytes);
    print_filling(info);
    if (info->damaged > 0)
        printf("damaged irradiances: %" PRIu64 "\n", info->damaged);
    printf("photons: %" PRIu64 " global, %" PRIu64 " caustic, of %" PRIu64 " paths\n", info->photons_global,
           info->photons_caustic, info->paths_emitted);
    printf("scene: %s\naimed at: %s\nprogram: %s\nmachine: %s\n%s", info->scene,
           info->view[0] ? info->view : "all views alike", info->program, info->machine, info->settings);
}

static ag_status tell(ag_context *context, int count, char **paths)
{
    for (int i = 0; i < count; i++) {
        ag_photon_map_info info;
        AG_TRY(ag_photon_map_read_info(context, paths[i], &info));
        if (i > 0)
            putchar('\n');
        print_info(paths[i], &info);
    }
    return AG_OK;
}

static ag_status merge(ag_context *context, int count, char **paths)
{
    ag_photon_map_info info;
    AG_TRY(ag_photon_map_merge(context, paths[0], (const char *const *)(void *)(paths + 1), (size_t)count - 1, &info));
    print_filling(&info);
    return AG_OK;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        fputs(HELP, stdout);
        return 0;
    }
    if (argc == 2 && strcmp(argv[1], "--version") == 0) {
        printf("afterglow-map %s\n", ag_version());
        return 0;
    }
    const int is_info = argc >= 3 && strcmp(argv[1], "info") == 0;
    if (!is_info && !(argc >= 4 && strcmp(argv[1], "merge") == 0)) {
        fputs("afterglow-map: error: it wants info FILE... or merge OUT FILE...; --help tells of both\n", stderr);
        return 2;
    }
    ag_context_settings settings = ag_default_context_settings();
    settings.thread_count = 1;
    settings.log = say;
    ag_context *context;
    ag_status status = ag_context_create(&settings, &context);
    if (status != AG_OK) {
        fprintf(stderr, "afterglow-map: error: %s\n", ag_status_text(status));
        return 3;
    }
    status = is_info ? tell(context, argc - 2, argv + 2) : merge(context, argc - 2, argv + 2);
    if (status == AG_OK && fflush(stdout) != 0)
        status = AG_ERROR_OUTPUT;
    if (status == AG_ERROR_MEMORY)
        fprintf(stderr, "afterglow-map: error: %s\n", ag_status_text(status));
    ag_context_destroy(context);
    return exit_code(status);
}
