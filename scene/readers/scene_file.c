/* scene_file.c: see scene_file.h. Threads: one per scene. */
#include "scene_file.h"

#include "model/import_file.h"
#include "pbrt/pbrt_parser.h"
#include "scene_overrides.h"
#include "scene_reader.h"
#include "status.h"

#include <string.h>
#include <strings.h>

static const struct {
    const char *ending;
    scene_reader *read;
} READERS[] = {
#define SCENE_READER_ROW(ending, reader) {ending, reader},
    SCENE_READER_LIST(SCENE_READER_ROW)
#undef SCENE_READER_ROW
};

static bool ends_with(const char *path, const char *ending)
{
    size_t length = strlen(path), ending_length = strlen(ending);
    return length >= ending_length && strcasecmp(path + length - ending_length, ending) == 0;
}

/* Text whose name no reader knows may be of another renderer. */
static ag_status read_unknown(run_context *run, const char *path, scene *out_scene)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    ag_status status = pbrt_parse_file(run, path, out_scene);
    if (status == AG_ERROR_SCENE && dot && strcasecmp(dot, ".gz") != 0 && import_finds_program(run, AG_LOG_WARNING))
        log_message(run->log, AG_LOG_WARNING, "no reader knows files that end in %s: this one was read as pbrt text",
                    dot);
    return status;
}

/* out_read: the reader of files of that name. */
static ag_status find_reader(const run_context *run, const char *path, scene_reader **out_read)
{
    *out_read = read_unknown;
    for (size_t k = 0; k < sizeof READERS / sizeof *READERS; k++)
        if (ends_with(path, READERS[k].ending)) {
            *out_read = READERS[k].read;
            return AG_OK;
        }
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    bool is_models = false;
    if (dot && dot[1] != '\0')
        AG_TRY(import_reads_extension(run, dot, &is_models));
    if (is_models)
        *out_read = import_file_load;
    return AG_OK;
}

/* Applies what the user asks for beyond what the file says. */
static ag_status finish(run_context *run, const char *path, bool is_pbrt, scene *out_scene)
{
    if (out_scene->request)
        AG_TRY(scene_overrides_apply(run, path, is_pbrt, out_scene));
    const definition *unused = definitions_unused(out_scene->definitions);
    if (!unused)
        return AG_OK;
    log_message(run->log, AG_LOG_ERROR, "%s: error: the scene has no $%s, which -D %s=%s is for", path, unused->name,
                unused->name, unused->value);
    return AG_ERROR_ARGUMENT;
}

ag_status scene_file_load(run_context *run, const char *path, scene *out_scene)
{
    scene_reader *read;
    AG_TRY(find_reader(run, path, &read));
    AG_TRY(read(run, path, out_scene));
    return finish(run, path, read == pbrt_parse_file || read == read_unknown, out_scene);
}

ag_status scene_file_load_text(run_context *run, const char *name, const char *text, size_t size, scene *out_scene)
{
    AG_TRY(pbrt_parse_text(run, name, text, size, out_scene));
    return finish(run, name, true, out_scene);
}
