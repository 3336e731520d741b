/* option_help.c: see option_help.h. */
#include "option_help.h"

#include "option_rows.h"

#include <assert.h>
#include <ctype.h>
#include <stdarg.h>
#include <string.h>

enum { LEFT_COLUMNS = 34, ALL_COLUMNS = 110 };
enum { TEXT_MAX = 8192 };

/* --- lists that stand in texts --- */

typedef struct text_list {
    char text[TEXT_MAX];
    size_t length;
} text_list;

static void append(text_list *list, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void append(text_list *list, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(list->text + list->length, sizeof list->text - list->length, format, arguments);
    va_end(arguments);
    assert(length >= 0 && list->length + (size_t)length < sizeof list->text);
    list->length += (size_t)length;
}

/* The options that a kept photon map depends on. */
static void append_photon_map_settings(text_list *list, bool is_manual)
{
    const ag_setting *setting;
    const char *mark = is_manual ? "*" : "", *gap = "";
    for (size_t i = 0; (setting = ag_setting_at(i)) != NULL; i++)
        if (setting->is_of_photon_map) {
            append(list, "%s%s--%s%s", gap, mark, setting->name, mark);
            gap = ", ";
        }
}

/* Returns whether this layer is the first of its group. */
static bool begins_group(size_t index)
{
    const char *group = ag_layer_at(index)->group;
    for (size_t i = 0; group && i < index; i++)
        if (ag_layer_at(i)->group && strcmp(ag_layer_at(i)->group, group) == 0)
            return false;
    return group != NULL;
}

/* "light: emission, direct, ..." */
static void append_group(text_list *list, const char *group, const char *mark)
{
    const ag_layer_info *layer;
    const char *gap = "";
    append(list, " %s%s%s: ", mark, group, mark);
    for (size_t i = 0; (layer = ag_layer_at(i)) != NULL; i++)
        if (layer->group && strcmp(layer->group, group) == 0) {
            append(list, "%s%s%s%s", gap, mark, layer->name, mark);
            gap = ", ";
        }
    append(list, "%s", mark[0] ? "." : ";");
}

static void append_layers(text_list *list, bool is_manual)
{
    const ag_layer_info *layer;
    const char *mark = is_manual ? "*" : "", *gap = "";
    for (size_t i = 0; (layer = ag_layer_at(i)) != NULL; i++) {
        if (is_manual)
            append(list, "%s*%s*: %s.", gap, layer->name, layer->about);
        else
            append(list, "%s%s", gap, layer->name);
        gap = is_manual ? " " : ", ";
    }
    append(list, "%s", is_manual ? "" : ";");
    for (size_t i = 0; ag_layer_at(i); i++)
        if (begins_group(i))
            append_group(list, ag_layer_at(i)->group, mark);
    append(list, " %sall%s: all of these but", mark, mark);
    gap = " ";
    for (size_t i = 0; (layer = ag_layer_at(i)) != NULL; i++)
        if (layer->is_left_out_of_all) {
            append(list, "%s%s%s%s", gap, mark, layer->name, mark);
            gap = ", ";
        }
    append(list, "%s", is_manual ? "." : "");
}

/* Returns the text with lists in the place of their names. */
static void fill_in(const char *text, bool is_manual, text_list *out)
{
    static const struct {
        const char *name;
        void (*append)(text_list *list, bool is_manual);
    } lists[] = {{"%PHOTON_MAP_SETTINGS%", append_photon_map_settings}, {"%LAYERS%", append_layers}};
    out->length = 0;
    out->text[0] = '\0';
    while (*text) {
        size_t plain = strcspn(text, "%"), i = 0;
        append(out, "%.*s", (int)plain, text);
        text += plain;
        while (i < sizeof lists / sizeof *lists && strncmp(text, lists[i].name, strlen(lists[i].name)) != 0)
            i++;
        if (i < sizeof lists / sizeof *lists) {
            lists[i].append(out, is_manual);
            text += strlen(lists[i].name);
        } else if (*text) {
            append(out, "%c", *text++);
        }
    }
}

/* --- --help --- */

/* Words, in lines that begin below each other. */
static void print_wrapped(FILE *out, const char *text)
{
    int column = LEFT_COLUMNS;
    while (*text) {
        int length = (int)strcspn(text, " ");
        if (column > LEFT_COLUMNS && column + 1 + length > ALL_COLUMNS) {
            fprintf(out, "\n%*s", LEFT_COLUMNS, "");
            column = LEFT_COLUMNS;
        } else if (column > LEFT_COLUMNS) {
            fputc(' ', out);
            column++;
        }
        fprintf(out, "%.*s", length, text);
        column += length;
        text += length + (text[length] == ' ');
    }
    fputc('\n', out);
}

void option_help_print(FILE *out)
{
    listed_option option;
    text_list filled;
    const char *section = "";
    fprintf(out, "usage: afterglow [options] SCENE\n"
                 "Renders a scene with photon mapping and final gathering: pbrt-v4 text (plain or gzip; - is standard "
                 "input), glTF,\n"
                 "OBJ, PLY, STL, Collada, FBX and what else assimp reads.\n"
                 "Values that are not given come from the scene, else from defaults.\n");
    for (size_t i = 0; option_at(i, &option); i++) {
        char left[64], letter[8] = "    ";
        if (strcmp(section, option.text->section) != 0)
            fprintf(out, "\n%s:\n", option.text->section);
        section = option.text->section;
        if (option.row && option.row->letter)
            snprintf(letter, sizeof letter, "-%c, ", option.row->letter);
        snprintf(left, sizeof left, "%s--%s%s%s", letter, option.text->name, option.text->argument ? " " : "",
                 option.text->argument ? option.text->argument : "");
        fprintf(out, "  %-*s", LEFT_COLUMNS - 2, left);
        fill_in(option.text->help, false, &filled);
        print_wrapped(out, filled.text);
    }
    fprintf(out, "\nExit status: 0 every file is complete on disk; 1 scene or input error; 2 usage; 3 system, or the "
                 "time limit\nwas reached before each pixel had a sample; 128 + n ended by signal n.\n");
}

void option_help_print_line(FILE *out, const ag_setting *option)
{
    text_list filled;
    fill_in(option->help, false, &filled);
    fprintf(out, "%s%s%s: %s\n", option->name, option->argument ? " " : "", option->argument ? option->argument : "",
            filled.text);
}

/* --- the man page --- */

/* Writes a character so that roff takes it for no request or escape. A hyphen stays a hyphen between letters of plain
 * text alone; elsewhere it is a minus, which can be copied. */
static void print_character(FILE *out, const char *at, char before, bool is_plain)
{
    if (*at == '\\')
        fputs("\\e", out);
    else if (*at == '"')
        fputs("\\(dq", out);
    else if (*at == '-' && (!is_plain || !isalpha((unsigned char)before) || !isalpha((unsigned char)at[1])))
        fputs("\\-", out);
    else
        fputc(*at, out);
}

/* Text with *bold* and _italic_ words, a line for each sentence. */
static void print_marked(FILE *out, const char *text)
{
    char font = 'R', before = ' ';
    for (const char *c = text; *c; before = *c++) {
        bool opens_italic = *c == '_' && font != 'B';
        if (*c == '*' || opens_italic) {
            char wanted = *c == '*' ? 'B' : 'I';
            font = font == wanted ? 'R' : wanted;
            fprintf(out, "\\f%c", font);
        } else if (*c == ' ' && font == 'R' && before == '.' && isupper((unsigned char)c[1])) {
            fputc('\n', out);
        } else {
            print_character(out, c, before, font == 'R');
        }
    }
    fputc('\n', out);
}

static void print_manual_text(FILE *out, const ag_setting *setting)
{
    text_list filled;
    char sentence[1024];
    const char *text = setting->manual;
    if (!text) { /* the help is a sentence but for its ends */
        snprintf(sentence, sizeof sentence, "%c%s.", toupper((unsigned char)setting->help[0]), setting->help + 1);
        text = sentence;
    }
    fill_in(text, true, &filled);
    print_marked(out, filled.text);
}

/* "--name" in bold. */
static void print_bold(FILE *out, const char *dashes, const char *name)
{
    fputs("\\fB", out);
    for (const char *c = dashes; *c; c++)
        print_character(out, c, ' ', false);
    for (const char *c = name; *c; c++)
        print_character(out, c, ' ', false);
    fputs("\\fR", out);
}

void option_help_print_manual(FILE *out)
{
    listed_option option;
    const char *section = "";
    for (size_t i = 0; option_at(i, &option); i++) {
        if (strcmp(section, option.text->section) != 0)
            fprintf(out, ".SS %s\n", option.text->section);
        section = option.text->section;
        fputs(".TP\n", out);
        if (option.row && option.row->letter) {
            print_bold(out, "-", (char[]){option.row->letter, '\0'});
            fputs(", ", out);
        }
        print_bold(out, "--", option.text->name);
        if (option.text->argument)
            fprintf(out, " \\fI%s\\fR", option.text->argument);
        fputc('\n', out);
        print_manual_text(out, option.text);
    }
}
