/* pbrt_lexer.h: the text of a pbrt-v4 scene file as tokens, each with its location in the file.
 * Rests on the format's description, pbrt.org/fileformat-v4.
 * Flow: text_file -> [here] -> pbrt_parser. Threads: one at a time. */
#ifndef AFTERGLOW_PBRT_LEXER_H
#define AFTERGLOW_PBRT_LEXER_H

#include "text/file_location.h"

#include <stddef.h>

typedef enum pbrt_token_kind {
    PBRT_TOKEN_END,
    PBRT_TOKEN_WORD,   /* a directive, a number, true, false: anything without quotes; ${...} may hold blanks */
    PBRT_TOKEN_STRING, /* text is what stands between the quotes, escapes resolved */
    PBRT_TOKEN_OPEN,   /* [ */
    PBRT_TOKEN_CLOSE   /* ] */
} pbrt_token_kind;

typedef struct pbrt_token {
    pbrt_token_kind kind;
    file_location where;
    size_t width;     /* bytes in the file, quotes and escapes included */
    const char *text; /* not NUL-terminated; valid until the lexer reads on */
    size_t length;
} pbrt_token;

typedef struct pbrt_lexer {
    const char *text, *end; /* borrowed; *end is NUL */
    const char *next;       /* the next character */
    const char *line_start; /* of the line that next is in */
    int line;
    const char *file; /* borrowed; goes into every location */
    char *unescaped;  /* owned; of the last string that had escapes */
    size_t unescaped_capacity;
    char error[96]; /* message of the last failure of pbrt_lexer_next */
} pbrt_lexer;

/* Borrows text, which has a NUL at text[size], and file. */
void pbrt_lexer_init(pbrt_lexer *lexer, const char *file, const char *text, size_t size);
void pbrt_lexer_reset(pbrt_lexer *lexer);

/* Reads the next token. On AG_ERROR_SCENE lexer->error says what is wrong, and out_token->where and width where.
 * Errors: AG_ERROR_SCENE, AG_ERROR_MEMORY. */
ag_status pbrt_lexer_next(pbrt_lexer *lexer, pbrt_token *out_token);

/* Reads numbers for as long as the next token is a finite one, at most max of them; returns how many. The fast way
 * through the large arrays; whatever else comes is left to pbrt_lexer_next. */
size_t pbrt_lexer_numbers(pbrt_lexer *lexer, size_t max, double *out_values);

/* Finds the value of a word that is a number from end to end, +-INFINITY if it is too large; returns false if it is
 * none. */
bool pbrt_token_number(const pbrt_token *token, double *out_value);
bool pbrt_token_is(const pbrt_token *token, pbrt_token_kind kind, const char *text);

/* Writes the line at where, with a mark: see text_excerpt. */
void pbrt_lexer_excerpt(const pbrt_lexer *lexer, file_location where, size_t width, char *out_text, size_t size);

#endif
