/* pbrt_files.c: the stack of scene files that include one another, as one stream of tokens.
 * Flow: text_file, pbrt_lexer -> [here] -> pbrt_parser. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "pbrt/pbrt_private.h"

#include "text/input_file.h"
#include "texture/texture_image_load.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const size_t PROGRESS_BYTES = (size_t)1 << 16;

void pbrt_excerpt(const void *user, file_location where, size_t width, char *out_text, size_t size)
{
    const pbrt_parser *parser = user;
    if (parser->given && where.file == parser->given->where.file) {
        snprintf(out_text, size, "\n    %s", parser->given->label);
        return;
    }
    for (int i = parser->file_count - 1; i >= 0; i--)
        if (parser->files[i].lexer.file == where.file) {
            pbrt_lexer_excerpt(&parser->files[i].lexer, where, width, out_text, size);
            break;
        }
}

ag_status pbrt_error(pbrt_parser *parser, file_location where, size_t width, const char *format, ...)
{
    char message[1024], excerpt[320] = "";
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    pbrt_excerpt(parser, where, width, excerpt, sizeof excerpt);
    log_at(parser->log, AG_LOG_ERROR, where, "%s%s", message, excerpt);
    return AG_ERROR_SCENE;
}

ag_status pbrt_unexpected(pbrt_parser *parser, const pbrt_token *token, const char *directive, const char *expected)
{
    enum { SHOWN = 60 };
    if (token->kind == PBRT_TOKEN_END)
        return pbrt_error(parser, token->where, 1, "%s expects %s, but the file ends", directive, expected);
    const char *quote = token->kind == PBRT_TOKEN_STRING ? "\"" : "";
    int shown = token->length > SHOWN ? SHOWN : (int)token->length;
    return pbrt_error(parser, token->where, token->width, "%s expects %s, not %s%.*s%s%s", directive, expected, quote,
                      shown, token->text, token->length > SHOWN ? "..." : "", quote);
}

/* Returns the directory of a path with its slash, or "". NULL when out of memory. */
static char *directory_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return strndup(path, slash ? (size_t)(slash - path) + 1 : 0);
}

static char *join(const char *directory, const char *name)
{
    size_t a = strlen(directory), b = strlen(name);
    char *path = malloc(a + b + 1);
    if (path) {
        memcpy(path, directory, a);
        memcpy(path + a, name, b + 1);
    }
    return path;
}

/* Asks the caller who loads the scene for the path that a name stands for; to be freed. Returns false where it has
 * none. An empty path is an error that is told here, since it names no file. */
static bool ask_for_file(const pbrt_parser *parser, const char *name, char **out_path)
{
    char path[4096] = "";
    const scene_request *asked = parser->scene->request;
    if (!asked || !asked->find_file || !asked->find_file(asked->find_file_user, name, path, sizeof path))
        return false;
    if (!path[0])
        log_message(parser->log, AG_LOG_ERROR, "find_file knows \"%s\", and gives no path", name);
    *out_path = strndup(path, sizeof path - 1);
    return true;
}

char *pbrt_find_file(const pbrt_parser *parser, const char *name)
{
    char *asked;
    if (ask_for_file(parser, name, &asked))
        return asked;
    if (name[0] == '/')
        return strdup(name);
    if (strcmp(name, "-") == 0)
        name = "./-"; /* a file: only the user may name standard input */
    char *path = join(parser->top_directory, name);
    char *directory = directory_of(parser->files[parser->file_count - 1].lexer.file);
    if (path && directory && !texture_image_is_there(parser->run, path)) {
        char *beside = join(directory, name);
        if (!beside || texture_image_is_there(parser->run, beside)) {
            free(path);
            path = beside;
        } else {
            free(beside);
        }
    }
    free(directory);
    return path;
}

const pbrt_picture *pbrt_find_picture(const pbrt_parser *parser, const char *name)
{
    for (size_t i = 0; i < parser->picture_count; i++)
        if (strcmp(parser->pictures[i].name, name) == 0)
            return &parser->pictures[i];
    return NULL;
}

ag_status pbrt_picture_version(const pbrt_parser *parser, const char *name, uint64_t *out_version)
{
    const pbrt_picture *in_memory = pbrt_find_picture(parser, name);
    char reason[128], *path = in_memory ? NULL : pbrt_find_file(parser, name);
    *out_version = in_memory ? in_memory->version : 0;
    if (!in_memory && !path)
        return AG_ERROR_MEMORY;
    if (path && input_file_allow(parser->run, path, reason, sizeof reason)) /* else who reads it says why */
        *out_version = input_file_version(path);
    free(path);
    return AG_OK;
}

ag_status pbrt_allow_picture(const pbrt_parser *parser, const char *path, char *message, size_t message_size)
{
    char reason[128];
    if (input_file_allow(parser->run, path, reason, sizeof reason))
        return AG_OK;
    snprintf(message, message_size, "cannot read '%s': %s", path, reason);
    return AG_ERROR_INPUT;
}

/* Lists the files that are open, innermost first: "a.pbrt:3 < b.pbrt:7 < ..." */
static void describe_chain(const pbrt_parser *parser, file_location where, char *out_text, size_t size)
{
    size_t used = (size_t)snprintf(out_text, size, "%s:%d", where.file, where.line);
    for (int i = parser->file_count - 1; i > 0 && used < size; i--) {
        file_location at = parser->files[i].included_at;
        used += (size_t)snprintf(out_text + used, size - used, " < %s:%d", at.file, at.line);
    }
}

static ag_status push(pbrt_parser *parser, const char *name, text_file *file, file_location where)
{
    const char *interned = scene_intern_file_name(parser->scene, name);
    if (!interned) {
        text_file_reset(file);
        return AG_ERROR_MEMORY;
    }
    pbrt_file *top = &parser->files[parser->file_count++];
    memset(top, 0, sizeof *top);
    top->file = *file;
    top->included_at = where;
    pbrt_lexer_init(&top->lexer, interned, file->text, file->size);
    return AG_OK;
}

ag_status pbrt_push_file(pbrt_parser *parser, const char *name, file_location where, size_t width)
{
    text_file file;
    char error[128], chain[640];
    if (parser->file_count == 0) {
        parser->top_directory = directory_of(strcmp(name, "-") == 0 ? "" : name);
        if (!parser->top_directory)
            return AG_ERROR_MEMORY;
        const char *shown = strcmp(name, "-") == 0 ? "<stdin>" : name;
        ag_status status = text_file_read(parser->run, name, error, sizeof error, &file);
        if (status == AG_ERROR_INPUT)
            log_at(parser->log, AG_LOG_ERROR, (file_location){shown, 0, 0}, "cannot read the file: %s", error);
        return status != AG_OK ? status : push(parser, shown, &file, where);
    }
    if (parser->file_count == PBRT_MAX_DEPTH) {
        describe_chain(parser, where, chain, sizeof chain);
        return pbrt_error(parser, where, width, "more than %d files include one another: %s", PBRT_MAX_DEPTH, chain);
    }
    if (parser->include_count++ == PBRT_MAX_INCLUDES) {
        describe_chain(parser, where, chain, sizeof chain);
        return pbrt_error(parser, where, width, "more than %d files are included: %s", PBRT_MAX_INCLUDES, chain);
    }
    char *path = pbrt_find_file(parser, name);
    ag_status status = path ? text_file_read(parser->run, path, error, sizeof error, &file) : AG_ERROR_MEMORY;
    if (status == AG_ERROR_INPUT)
        pbrt_error(parser, where, width, "cannot read the file \"%s\": %s", name, error);
    if (status != AG_OK) {
        free(path);
        return status;
    }
    parser->text_bytes += file.size;
    if (parser->text_bytes > text_file_max_bytes()) {
        describe_chain(parser, where, chain, sizeof chain);
        status = pbrt_error(parser, where, width, "more than %zu MiB of text are included: %s",
                            text_file_max_bytes() >> 20, chain);
    }
    for (int i = 0; i < parser->file_count && status == AG_OK; i++) {
        const text_file *open = &parser->files[i].file;
        if (open->inode == file.inode && open->device == file.device && open->inode != 0) {
            describe_chain(parser, where, chain, sizeof chain);
            status = pbrt_error(parser, where, width, "\"%s\" includes itself: %s", name, chain);
        }
    }
    if (status != AG_OK)
        text_file_reset(&file);
    else
        status = push(parser, path, &file, where);
    free(path);
    return status;
}

ag_status pbrt_push_text(pbrt_parser *parser, const char *name, const char *text, size_t size)
{
    if (size > text_file_max_bytes()) {
        log_message(parser->log, AG_LOG_ERROR, "%s: the text is larger than %zu MiB, which is the most", name,
                    text_file_max_bytes() >> 20);
        return AG_ERROR_INPUT;
    }
    text_file file = {.text = malloc(size + 1), .size = size};
    parser->top_directory = directory_of(name);
    if (!file.text || !parser->top_directory) {
        free(file.text);
        return AG_ERROR_MEMORY;
    }
    if (size > 0)
        memcpy(file.text, text, size);
    file.text[size] = '\0';
    return push(parser, name, &file, (file_location){NULL, 0, 0});
}

void pbrt_pop_file(pbrt_parser *parser)
{
    pbrt_file *top = &parser->files[--parser->file_count];
    if (top->value.has_tokens)
        pbrt_lexer_reset(&top->value.lexer);
    free(top->value.text);
    free(top->coordinate_systems);
    name_table_reset(&top->coordinate_system_names);
    pbrt_lexer_reset(&top->lexer);
    text_file_reset(&top->file);
}

/* Finds the next token of a value that stands without quotes; PBRT_TOKEN_END: it has no more. */
static ag_status next_of_value(pbrt_parser *parser, pbrt_value *value, pbrt_token *out_token)
{
    ag_status status = pbrt_lexer_next(&value->lexer, out_token);
    out_token->where = value->where;
    out_token->width = value->width;
    if (status == AG_ERROR_SCENE)
        return pbrt_error(parser, value->where, value->width, "in the value \"%s\": %s", value->text,
                          value->lexer.error);
    if (status == AG_OK && out_token->kind == PBRT_TOKEN_END) {
        pbrt_lexer_reset(&value->lexer);
        value->has_tokens = false;
    }
    return status;
}

/* Puts values instead of $name: into a string, or as tokens, which then are the next. */
static ag_status fill_in(pbrt_parser *parser, pbrt_file *file, pbrt_token *token)
{
    char message[256], *text;
    size_t length;
    ag_status status = definitions_expand(parser->scene->definitions, token->text, token->length,
                                          token->kind == PBRT_TOKEN_STRING, message, sizeof message, &text, &length);
    if (status == AG_ERROR_SCENE)
        return pbrt_error(parser, token->where, token->width, "%s", message);
    if (status != AG_OK || !text)
        return status;
    free(file->value.text);
    file->value.text = text;
    if (token->kind == PBRT_TOKEN_STRING) {
        token->text = text;
        token->length = length;
        return AG_OK;
    }
    pbrt_lexer_init(&file->value.lexer, token->where.file, text, length);
    file->value.has_tokens = true;
    file->value.where = token->where;
    file->value.width = token->width;
    return AG_OK;
}

/* Finds the next string of a call, which ends behind its strings. */
static ag_status next_given(pbrt_given *given, pbrt_token *out_token)
{
    *out_token = (pbrt_token){.kind = PBRT_TOKEN_END, .where = given->where, .width = 1};
    if (given->next_string < given->string_count) {
        out_token->kind = PBRT_TOKEN_STRING;
        out_token->text = given->strings[given->next_string++];
        out_token->length = strlen(out_token->text);
    }
    return AG_OK;
}

ag_status pbrt_next(pbrt_parser *parser, pbrt_token *out_token)
{
    if (parser->has_peeked) {
        parser->has_peeked = false;
        *out_token = parser->peeked;
        return AG_OK;
    }
    if (parser->given)
        return next_given(parser->given, out_token);
    for (;;) {
        pbrt_file *file = &parser->files[parser->file_count - 1];
        if (file->value.has_tokens) {
            AG_TRY(next_of_value(parser, &file->value, out_token));
            if (file->value.has_tokens)
                return AG_OK;
        }
        ag_status status = pbrt_lexer_next(&file->lexer, out_token);
        if (status == AG_ERROR_SCENE)
            return pbrt_error(parser, out_token->where, out_token->width, "%s", file->lexer.error);
        if (status == AG_OK && (out_token->kind == PBRT_TOKEN_STRING || out_token->kind == PBRT_TOKEN_WORD) &&
            out_token->length > 0 && memchr(out_token->text, '$', out_token->length)) {
            AG_TRY(fill_in(parser, file, out_token));
            if (file->value.has_tokens)
                continue;
        }
        if (status != AG_OK || out_token->kind != PBRT_TOKEN_END || parser->file_count == 1 || file->is_import)
            return status;
        pbrt_pop_file(parser);
    }
}

ag_status pbrt_peek(pbrt_parser *parser, pbrt_token *out_token)
{
    if (!parser->has_peeked) {
        AG_TRY(pbrt_next(parser, &parser->peeked));
        parser->has_peeked = true;
    }
    *out_token = parser->peeked;
    return AG_OK;
}

ag_status pbrt_read_string(pbrt_parser *parser, const char *directive, const char *expected, char **out_text,
                           file_location *out_where)
{
    pbrt_token token;
    AG_TRY(pbrt_next(parser, &token));
    if (token.kind != PBRT_TOKEN_STRING)
        return pbrt_unexpected(parser, &token, directive, expected);
    if (out_where)
        *out_where = token.where;
    *out_text = strndup(token.text, token.length);
    return *out_text ? AG_OK : AG_ERROR_MEMORY;
}

ag_status pbrt_read_numbers(pbrt_parser *parser, const char *directive, size_t count, double *out_values)
{
    for (size_t i = 0; i < count; i++) {
        char expected[32];
        pbrt_token token;
        AG_TRY(pbrt_next(parser, &token));
        if (!pbrt_token_number(&token, &out_values[i])) {
            snprintf(expected, sizeof expected, "%zu numbers", count);
            return pbrt_unexpected(parser, &token, directive, expected);
        }
        if (!isfinite(out_values[i]))
            return pbrt_error(parser, token.where, token.width, "the number is too large");
    }
    return AG_OK;
}

ag_status pbrt_tell_progress(pbrt_parser *parser)
{
    const pbrt_lexer *lexer = &parser->files[0].lexer;
    const size_t bytes = (size_t)(lexer->next - lexer->text);
    /* a short text may name large files, which take their time */
    const size_t part = parser->files[0].file.size / 256, step = part < PROGRESS_BYTES ? part : PROGRESS_BYTES;
    if (bytes > parser->told_bytes + step) {
        parser->told_bytes = bytes;
        run_progress(parser->run, AG_PHASE_LOAD, (double)bytes / (double)parser->files[0].file.size);
    }
    return run_is_cancelled(parser->run) ? AG_CANCELLED : AG_OK;
}
