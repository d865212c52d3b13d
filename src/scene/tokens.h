/* Text as a row of tokens with their places, for formats of words and numbers between blanks. */
#ifndef TURNER_SCENE_TOKENS_H
#define TURNER_SCENE_TOKENS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/result.h"

struct turner_token {
    const char *text;    /* not ended by NUL */
    size_t length;       /* 0 at the end of the file */
    size_t line, column; /* from 1, columns in bytes */
};

struct turner_tokens {
    const char *path; /* for messages */
    struct turner_token token, last; /* the current token and the one before */
    const char *next, *end, *line_start;
    size_t line;
};

/* Stands at the first token afterwards. `#` starts a comment that ends with the line. The text need
 * not end in NUL and stays with the caller, as does `path`. */
void turner_tokens_begin(struct turner_tokens *tokens, const char *text, size_t length,
                         const char *path);

void turner_tokens_advance(struct turner_tokens *tokens);

/* Whether the current token is `word`. */
bool turner_tokens_at(const struct turner_tokens *tokens, const char *word);

/* Whether the current token starts like a number. */
bool turner_tokens_at_number(const struct turner_tokens *tokens);

/* Takes a decimal number with low ≤ value ≤ high that is finite also as a 32-bit float. The failure
 * calls it `what`. */
enum turner_result turner_tokens_number(struct turner_tokens *tokens, double *value,
                                        const char *what, double low, double high);

/* The same for a whole number. */
enum turner_result turner_tokens_integer(struct turner_tokens *tokens, int *value,
                                         const char *what, int low, int high);

/* Takes `word`. */
enum turner_result turner_tokens_word(struct turner_tokens *tokens, const char *word);

/* TURNER_BAD_INPUT: `path:line:column: expected …, found "token"` for the current token. */
enum turner_result turner_tokens_expected(const struct turner_tokens *tokens, const char *format,
                                          ...) TURNER_PRINTF(2, 3);

/* TURNER_BAD_INPUT: `path:line:column: …` at `token`. */
enum turner_result turner_tokens_fail(const struct turner_tokens *tokens,
                                      const struct turner_token *token, const char *format, ...)
    TURNER_PRINTF(3, 4);

#endif
