/* option_help.c: see option_help.h. */
#include "option_help.h"

#include "option_rows.h"

#include <ctype.h>
#include <string.h>

enum { LEFT_COLUMNS = 34, ALL_COLUMNS = 110 };
/* In a manual text: the names of all settings that a kept photon map depends on. */
static const char PHOTON_MAP_SETTINGS[] = "%PHOTON_MAP_SETTINGS%";

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
        print_wrapped(out, option.text->help);
    }
    fprintf(out, "\nExit status: 0 every file is complete on disk; 1 scene or input error; 2 usage; 3 system;\n"
                 "128 + n ended by signal n.\n");
}

/* --- the man page --- */

/* A character, so that roff takes it for no request or escape; a hyphen only between letters of plain text. */
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

/* "*--seed*, *--photons*, ...": the settings that a kept photon map depends on. */
static void list_photon_map_settings(char *out, size_t size)
{
    const ag_setting *setting;
    size_t used = 0;
    out[0] = '\0';
    for (size_t i = 0; (setting = ag_setting_at(i)) != NULL; i++)
        if (setting->is_of_photon_map && used < size)
            used += (size_t)snprintf(out + used, size - used, "%s*--%s*", used > 0 ? ", " : "", setting->name);
}

static void print_manual_text(FILE *out, const ag_setting *setting)
{
    char text[8192], list[1024];
    const char *manual = setting->manual, *place = manual ? strstr(manual, PHOTON_MAP_SETTINGS) : NULL;
    list_photon_map_settings(list, sizeof list);
    if (!manual) /* the help is a sentence but for its ends */
        snprintf(text, sizeof text, "%c%s.", toupper((unsigned char)setting->help[0]), setting->help + 1);
    else if (place)
        snprintf(text, sizeof text, "%.*s%s%s", (int)(place - manual), manual, list,
                 place + strlen(PHOTON_MAP_SETTINGS));
    else
        snprintf(text, sizeof text, "%s", manual);
    print_marked(out, text);
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
