/* option_rows.c: see option_rows.h. */
#include "option_row_lists.h"

#include <stdlib.h>
#include <string.h>

static const option_row_list *const LISTS[] = {&option_rows_output, &option_rows_scene, &option_rows_work};
enum { LIST_COUNT = sizeof LISTS / sizeof *LISTS };

static const char *const SECTIONS[] = {"Output", "Scene", "Picture", "Light", "Work"};
enum { SECTION_COUNT = sizeof SECTIONS / sizeof *SECTIONS };

bool option_at(size_t index, listed_option *out_option)
{
    const ag_setting *setting;
    for (int s = 0; s < SECTION_COUNT; s++) {
        for (int l = 0; l < LIST_COUNT; l++)
            for (size_t i = 0; i < LISTS[l]->count; i++) {
                const option_row *row = &LISTS[l]->rows[i];
                if (strcmp(row->text.section, SECTIONS[s]) == 0 && index-- == 0) {
                    *out_option = (listed_option){&row->text, row};
                    return true;
                }
            }
        for (size_t i = 0; (setting = ag_setting_at(i)) != NULL; i++)
            if (strcmp(setting->section, SECTIONS[s]) == 0 && index-- == 0) {
                *out_option = (listed_option){setting, NULL};
                return true;
            }
    }
    return false;
}

/* A seed with a placeholder for the frame's number is checked with a number in its place. */
static bool take_seed_pattern(const char *value, options *o)
{
    char *tried = frames_name(value, 1);
    const bool is_valid = tried && ag_render_settings_set(&o->render, "seed", tried) == AG_OK;
    free(tried);
    o->seed_pattern = value;
    return is_valid;
}

/* A setting is checked on o->render, and noted for options_override. */
static bool take_setting(const ag_setting *setting, const char *value, options *o)
{
    if (strcmp(setting->name, "seed") == 0) {
        o->seed_pattern = NULL; /* the last one counts */
        if (frames_has_placeholder(value))
            return take_seed_pattern(value, o);
    }
    if (ag_render_settings_set(&o->render, setting->name, value) != AG_OK)
        return false;
    o->given[o->given_count++] = (given_setting){setting->name, value};
    return true;
}

bool option_take(const listed_option *option, const char *value, options *o)
{
    const option_row *row = option->row;
    if (!row)
        return take_setting(option->text, value, o);
    switch (row->kind) {
    case OPTION_TAKEN: return row->take(value, o);
    case OPTION_FLAG: *(bool *)((unsigned char *)o + row->offset) = true; break;
    case OPTION_TEXT: *(const char **)(void *)((unsigned char *)o + row->offset) = value; break;
    }
    return true;
}
