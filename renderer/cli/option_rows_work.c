/* option_rows_work.c: see option_row_lists.h. help is for --help; manual is for the man page, *bold* and _italic_. */
#define _GNU_SOURCE
#include "option_row_lists.h"

#include "display_address.h"
#include "option_values.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool take_tile(const char *value, options *o) { return parse_tile(value, &o->tile_index, &o->tile_count); }

static bool take_threads(const char *value, options *o)
{
    int threads = 0;
    bool is_valid = parse_int(value, 1, 4096, &threads);
    o->context.thread_count = (unsigned)threads;
    return is_valid;
}

static bool take_isa(const char *value, options *o)
{
    int word;
    o->context.isa = value;
    return parse_word(value, WORDS("sse2", "sse4.2", "avx", "avx2", "avx512"), &word);
}

static bool take_frames(const char *value, options *o)
{
    frames_reset(&o->frames);
    return frames_parse(value, &o->frames);
}

static bool take_checkpoint(const char *value, options *o) { return parse_seconds(value, &o->checkpoint_seconds); }

static bool take_time_limit(const char *value, options *o) { return parse_time(value, &o->time_limit); }

static bool take_memory(const char *value, options *o) { return parse_bytes(value, &o->memory_limit); }

static bool take_display_server(const char *value, options *o)
{
    display_address address;
    o->display_server = value;
    return display_address_parse(value, &address);
}

static bool take_serve(const char *value, options *o)
{
    o->serves = true;
    return parse_int(value, 0, 65535, &o->serve_port);
}

static bool take_serve_address(const char *value, options *o)
{
    unsigned char address[sizeof(struct in6_addr)];
    o->serve_address = value;
    return inet_pton(AF_INET, value, address) == 1 || inet_pton(AF_INET6, value, address) == 1;
}

static bool take_progress(const char *value, options *o)
{
    static const progress_style styles[] = {PROGRESS_AUTO,    PROGRESS_BAR,     PROGRESS_PLAIN,  PROGRESS_JSON,
                                            PROGRESS_NONE,    PROGRESS_ALF,     PROGRESS_PLAIN,  PROGRESS_NONE,
                                            PROGRESS_PICTURE, PROGRESS_PICTURE, PROGRESS_PICTURE};
    enum { BLOCKS = 9, SIXEL };
    int word;
    if (!parse_word(value,
                    WORDS("auto", "bar", "plain", "json", "none", "alf", "lines", "off", "picture", "blocks", "sixel"),
                    &word))
        return false;
    o->progress = styles[word];
    o->picture_form = word == BLOCKS ? PICTURE_FORM_BLOCKS : word == SIXEL ? PICTURE_FORM_SIXELS : PICTURE_FORM_AUTO;
    return true;
}

static bool take_quiet(const char *value, options *o)
{
    (void)value;
    o->verbosity = -1;
    return true;
}

static bool take_verbose(const char *value, options *o)
{
    (void)value;
    o->verbosity = o->verbosity < 0 ? 1 : o->verbosity + 1;
    return true;
}

static bool take_help(const char *value, options *o)
{
    (void)value;
    o->asked_text = OPTIONS_ASKED_HELP;
    return true;
}

static bool take_version(const char *value, options *o)
{
    (void)value;
    o->asked_text = OPTIONS_ASKED_VERSION;
    return true;
}

static const option_row ROWS[] = {
    {.text = {.name = "tile",
              .argument = "I/N",
              .section = "Picture",
              .help = "the I-th of N bands of the picture, from the top, from 1 on",
              .manual = "The _I_-th of _N_ bands of the picture (or of its crop window), from the top, from 1 on, "
                        "for rendering it on several machines. The pixels are those of the whole picture, to the "
                        "last bit; in _.exr_ files the data window says where they belong, and *oiiotool* puts the "
                        "bands together, see EXAMPLES."},
     .take = take_tile},
    {.text = {.name = "nthreads",
              .argument = "N",
              .section = "Work",
              .help = "threads (default: what affinity mask and cgroup quota allow)",
              .manual = "Number of threads. The default is what the affinity mask and the cgroup's quota allow."},
     .letter = 't',
     .take = take_threads},
    {.text = {.name = "isa",
              .argument = "NAME",
              .section = "Work",
              .help = "widest instruction set of ray traversal: sse2, sse4.2, avx, avx2 (default), avx512; another "
                      "one may give other bits",
              .manual = "Widest instruction set of ray traversal: *sse2*, *sse4.2*, *avx*, *avx2* (default) or "
                        "*avx512*. Another one may give other bits."},
     .take = take_isa},
    {.text = {.name = "frames",
              .argument = "LIST",
              .section = "Work",
              .help = "render frames, as 1-100, 1-100x2 or 1,5,9; %d, %04d and #### in names of files, SCENE too, "
                      "and in -D's values are the frame's number",
              .manual = "Render the frames of _LIST_, one after the other: *1-100*, *1-100x2*, *1,5,9* or several of "
                        "these with commas between. In the names of outfiles, of _SCENE_ and of other files written, "
                        "and in the values of *-D*, *%d*, *%04d* and runs of *#* (a digit each, at least) are the "
                        "frame's number. Statistics and limits of time are each frame's own. The first frame that "
                        "fails ends the work."},
     .take = take_frames},
    {.text = {.name = "no-clobber",
              .section = "Work",
              .help = "skip pictures that are there already, and complete",
              .manual = "Skip pictures whose files are all there and complete; a message says so. What was left by a "
                        "render that ended early is not complete."},
     FLAG(no_clobber)},
    {.text = {.name = "seed-per-frame",
              .section = "Work",
              .help = "with --frames: each frame's number is added to the seed, so that noise differs from frame to "
                      "frame",
              .manual =
                  "With *--frames*: each frame's number is added to the seed, so that noise does not stand still "
                  "over the moving picture. Without it all frames have one seed; *--seed* may also have a placeholder "
                  "for the number, _%d_ or _####_. With *--photon-map* the photons keep one seed."},
     FLAG(seed_per_frame)},
    {.text = {.name = "checkpoint",
              .argument = "SECONDS",
              .section = "Work",
              .help = "write down what there is so often, and at a signal, to OUTFILE.afterglow-checkpoint",
              .manual = "Write down what there is so often, and at a signal, to _OUTFILE_.afterglow-checkpoint "
                        "beside the first outfile. It is removed when the picture is complete."},
     .take = take_checkpoint},
    {.text = {.name = "resume",
              .section = "Work",
              .help = "go on from that file, where it is there, to the same bits",
              .manual =
                  "Go on from that file, where it is there. The picture has the bits of one that was never "
                  "cut, however its render ended: by a signal, SIGKILL, or a power failure. A checkpoint of "
                  "another scene, other settings, another version or a build whose photon map has other light, "
                  "and one that is damaged, is refused, and the message says which; scenes are compared by what is in "
                  "them, so that files may have moved."},
     FLAG(resume)},
    {.text =
         {.name = "time-limit",
          .argument = "TIME",
          .section = "Work",
          .help = "stop after so many seconds, or HH:MM:SS, with the samples that there are",
          .manual =
              "Seconds, or HH:MM:SS, from the beginning of the scene's reading on, for each picture. No pass over the "
              "picture is begun that would not end in time, as the one before tells, so that all pixels "
              "have the same number of samples, unless a pass takes longer than was to be expected: it ends with the "
              "limit. The picture counts as "
              "complete, and a message says how many samples it has; with *--checkpoint* a checkpoint "
              "stays for *--resume* to go on with. A limit that is reached before each pixel has one sample ends "
              "the run with exit status 3: within the first sample what there is of the picture is written and marked "
              "as unfinished, "
              "as at a signal; while the scene is read or photons are traced nothing is written but the statistics. "
              "Files are written, "
              "and denoised, after the limit. "
              "*--dry-run* does not heed it."},
     .take = take_time_limit},
    {.text =
         {.name = "memory",
          .argument = "SIZE",
          .section = "Work",
          .help = "the process may have so much memory, in bytes or as 500M or 8G: a picture that would need more "
                  "is not begun",
          .manual =
              "The process may have so much memory: bytes, or with K, M, G or T at the end times 1024, "
              "1024^2, ... What a picture will need is predicted when the scene is there (see "
              "*--dry-run*): where it is more, a message tells how much and for what, and the exit status "
              "is 3. A run that needs more all the same ends for want of memory instead of taking it from "
              "others; since libraries reserve memory that they never touch, 24 MB beyond are allowed then. While the "
              "scene is read "
              "the memory that is in use is looked at every 2 ms, and reading ends when it is more, and 24 MB more "
              "than before; it may be passed by "
              "what is taken meanwhile, up to 256 MB."},
     .take = take_memory},
    {.text =
         {.name = "dry-run",
          .section = "Work",
          .help = "render no picture: predict how long it would take and how much memory, and print that",
          .manual =
              "Load the scene, predict how long the picture would take on this machine, were it idle, and "
              "how much memory at the most, print that on standard output, and write no picture. For the "
              "time photons are traced, one and a half million into each map at most, and some hundred blocks of the "
              "picture's pixels are rendered, or half of them where it is small. *--stats* has the times, the CPU time "
              "and "
              "the memory by its parts under _prediction_. What *--denoise* takes is not in it, and limits of time, "
              "checkpoints and "
              "photon maps that are kept already are not heeded."},
     FLAG(dry_run)},
    {.text = {.name = "preview",
              .section = "Work",
              .help = "write the picture after 1, 2, 4, ... samples per pixel, too",
              .manual = "Write the picture after 1, 2, 4, ... samples per pixel, too."},
     FLAG(preview)},
    {.text = {.name = "display-server",
              .argument = "HOST:PORT",
              .section = "Work",
              .help = "send the picture, tile by tile, to a viewer that listens there, as tev does on port 14158",
              .manual =
                  "Send the picture to a viewer that listens there while it is rendered, tile by tile as they are "
                  "done: *tev* does, on port 14158 of its machine, and whatever else knows its protocol, which is "
                  "that of pbrt's *--display-server* as well. The viewer shows it under the first outfile's name, "
                  "with the values that the picture has in _.exr_ files in the working space; in the end it has "
                  "all that the file has, denoised where that is asked for. The pixels are those that are "
                  "rendered: of a crop window or a tile no more. A viewer that is not there, or is lost, is "
                  "named in one warning and looked for again every two seconds; the render never waits for it. "
                  "When the files are written, the program waits until it has the whole picture, but for at most "
                  "five seconds in which it takes nothing, ten seconds in all, and no longer than *--time-limit* "
                  "allows; a signal ends the wait. An IPv6 address stands in brackets. The connection is not "
                  "encrypted."},
     .take = take_display_server},
    {.text =
         {.name = "serve",
          .argument = "PORT",
          .section = "Work",
          .help = "show the picture in a browser while it is rendered: a page on that port of this machine, at the URL "
                  "that is told; 0: a port that is free",
          .manual =
              "Show the picture in a browser while it is rendered, by a page on that port of this machine, or with 0 "
              "on "
              "one that is free. Its URL, with a token that no one can guess, is told on standard error. The page "
              "has the picture and every layer of *--aov*, through any display and view of the config and any "
              "exposure, "
              "says how far the work is and what takes it, and has a button to stop and keep: the picture as of the "
              "last pass over it that is complete is then written, counts as complete, and the exit status is 0; with "
              "*--checkpoint* a checkpoint stays for *--resume*. Keys and mouse move the camera, where *Walk* is "
              "chosen "
              "on the page: the scene is then rendered from elsewhere, on the same photon map, coarsely first, while "
              "the "
              "picture waits for *Back to the picture*, or for nobody to look any more; *Stop and keep* writes what is "
              "seen from there. The picture that is written otherwise has the same bits as without the page. While the "
              "page is looked at, the program does not end when the files are "
              "written, but for *--time-limit*, until *Stop* is pressed. Requests without the token are "
              "refused, as are those under another machine's name or from another site's page; none names a file. The "
              "film is in memory twice; *--memory* and *--dry-run* count that and the page's own pictures, but not "
              "layers "
              "that are looked at, nor a walk: both are left where there is no memory for them."},
     .take = take_serve},
    {.text = {.name = "serve-address",
              .argument = "ADDRESS",
              .section = "Work",
              .help = "listen at that address, a number, for --serve (default: 127.0.0.1, which this machine alone "
                      "reaches)",
              .manual =
                  "Listen at that address for *--serve*: a number of IPv4 or IPv6; *0.0.0.0* and *::* are all of "
                  "this machine's. The default, *127.0.0.1*, is reached from this machine alone. The connection "
                  "is not encrypted: who can listen to it on its way learns the token, so that a tunnel (*ssh -L*) "
                  "is the better way over a network that is not one's own."},
     .take = take_serve_address},
    {.text =
         {.name = "progress",
          .argument = "STYLE",
          .section = "Work",
          .help =
              "auto (default), bar, picture (in the terminal; blocks or sixel: by these), plain (or lines), alf, json "
              "or none (or off)",
          .manual =
              "*auto* (default: a bar on a terminal, else plain), *bar*, *picture*, *blocks* or *sixel* (see below), "
              "*plain* or *lines* (whole lines "
              "with *Progress: NN%*), *alf* (lines with *ALF_PROGRESS NN%* on standard output, as render "
              "queues read them), *json* (one object per line), *none* or *off*. Where it can be told, "
              "each says how long the phase will take. *picture* draws the picture into the terminal while it is "
              "rendered, above the bar, through *--display*, *--view* and *--exposure* as a _.png_ file, as large as "
              "fits, at most four times a second: pixel by pixel as sixels in up to 256 colours of its own where the "
              "terminal "
              "says that it has them, and how large its characters are, else as half blocks (U+2580) in 24-bit "
              "colours. The terminal is asked for it at the beginning, and has a second for its answer; it is "
              "not asked by *blocks* (half blocks) and *sixel* (characters are taken for 10 x 20 pixels where "
              "the system knows no size), nor in the background, nor where keys have been pressed already. The picture "
              "stays there in the end, after *--denoise* where that is asked for. Where standard error is "
              "no terminal, or one without colours or of less than 20 columns and 6 rows, a warning says "
              "so, and progress is *auto*."},
     .take = take_progress},
    {.text = {.name = "quiet", .section = "Work", .help = "errors only", .manual = "Errors only."},
     .letter = 'q',
     .take = take_quiet},
    {.text = {.name = "verbose",
              .section = "Work",
              .help = "also say what was done; twice: also what is harmless in the scene",
              .manual = "Say more; twice: everything."},
     .letter = 'v',
     .take = take_verbose},
    {.text = {.name = "help",
              .section = "Work",
              .help = "print this text",
              .manual = "Print a summary of the options and exit."},
     .letter = 'h',
     .take = take_help},
    {.text = {.name = "version",
              .section = "Work",
              .help = "print the program's version",
              .manual = "Print the program's version and exit."},
     .take = take_version},
};

const option_row_list option_rows_work = {ROWS, sizeof ROWS / sizeof *ROWS};
