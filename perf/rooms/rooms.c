/* rooms.c: the program afterglow-rooms, which writes the forty rooms as scene files and tells how near things come.
 * After the test suite of Neilson & Yang (TR 04-21, 2004).
 * Flow: room_layout -> room_file -> [here]. Threads: one. */
#include "rooms/room_file.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char usage_text[] =
    "usage: afterglow-rooms --out DIR [--first N] [--last N] [--gather N]\n"
    "Writes the paper's rooms as DIR/room-NN.pbrt. Room n holds the first n of forty spheres.\n"
    "  --out DIR    the folder; it is made if it is not there (its parent must be)\n"
    "  --first N    first room, 1 to 40 (1)\n"
    "  --last N     last room, 1 to 40 (40)\n"
    "  --gather N   gather rays at each gather point, 1 to 65536 (16)\n"
    "  --help       this text\n";

static bool parse_number(const char *name, const char *text, int low, int high, int *out_value)
{
    char *end = NULL;
    errno = 0;
    const long value = strtol(text, &end, 10);
    if (errno != 0 || end == text || *end != '\0' || value < low || value > high) {
        fprintf(stderr, "afterglow-rooms: error: --%s wants a whole number from %d to %d, not '%s'\n", name, low, high,
                text);
        return false;
    }
    *out_value = (int)value;
    return true;
}

/* 0, or 2 after a usage error, or -1 when the text was asked for. */
static int parse_options(int argc, char **argv, const char **out_folder, int *out_first, int *out_last,
                         int *out_gather_samples)
{
    static const struct option options[] = {
        {"out", required_argument, NULL, 'o'},  {"first", required_argument, NULL, 'f'},
        {"last", required_argument, NULL, 'l'}, {"gather", required_argument, NULL, 'g'},
        {"help", no_argument, NULL, 'h'},       {NULL, 0, NULL, 0}};
    for (int choice; (choice = getopt_long(argc, argv, "", options, NULL)) != -1;) {
        bool good = true;
        switch (choice) {
        case 'o': *out_folder = optarg; break;
        case 'f': good = parse_number("first", optarg, 1, ROOM_COUNT, out_first); break;
        case 'l': good = parse_number("last", optarg, 1, ROOM_COUNT, out_last); break;
        case 'g': good = parse_number("gather", optarg, 1, 65536, out_gather_samples); break;
        case 'h': fputs(usage_text, stdout); return -1;
        default: good = false; break;
        }
        if (!good) {
            return 2;
        }
    }
    if (*out_folder == NULL || optind != argc || *out_first > *out_last) {
        fputs(usage_text, stderr);
        return 2;
    }
    return 0;
}

int main(int argc, char **argv)
{
    const char *folder = NULL;
    int first = 1, last = ROOM_COUNT, gather_samples = 16;
    const int usage = parse_options(argc, argv, &folder, &first, &last, &gather_samples);
    if (usage != 0) {
        return usage < 0 ? EXIT_SUCCESS : usage;
    }

    room_sphere spheres[ROOM_COUNT];
    if (room_layout_place(ROOM_SEED, spheres) != AG_OK) {
        fprintf(stderr, "afterglow-rooms: error: no room is left for a sphere\n");
        return 1;
    }
    const room_clearance clearance = room_layout_clearance(spheres, last);
    if (fmin(fmin(clearance.wall, clearance.sphere), fmin(clearance.eye, clearance.light)) <= 0.0) {
        fprintf(stderr, "afterglow-rooms: error: two things touch\n");
        return 1;
    }

    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        fprintf(stderr, "%s: error: %s\n", folder, strerror(errno));
        return 3;
    }
    const size_t path_size = strlen(folder) + 40;
    char *path = malloc(path_size);
    if (path == NULL) {
        fprintf(stderr, "afterglow-rooms: error: out of memory\n");
        return 3;
    }
    int exit_code = EXIT_SUCCESS;
    for (int number = first; number <= last && exit_code == EXIT_SUCCESS; ++number) {
        char name[32];
        room_file_name(number, name, sizeof name);
        snprintf(path, path_size, "%s/%s", folder, name);
        if (room_file_write(path, spheres, number, gather_samples) != AG_OK) {
            fprintf(stderr, "%s: error: %s\n", path, strerror(errno));
            exit_code = 3;
        }
    }
    free(path);
    if (exit_code == EXIT_SUCCESS) {
        printf("rooms %d to %d written to %s\n", first, last, folder);
        printf("smallest clearance in room %d: wall %.3f, eye %.3f, light %.3f", last, clearance.wall, clearance.eye,
               clearance.light);
        if (last > 1) {
            printf(", sphere to sphere %.3f", clearance.sphere);
        }
        printf("\n");
    }
    return exit_code;
}
