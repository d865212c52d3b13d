#include "scene/tokens.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"

#define MAX_SHOWN_LENGTH 40

void turner_tokens_begin(struct turner_tokens *tokens, const char *text, size_t length,
                         const char *path)
{
    *tokens = (struct turner_tokens){.path = path, .next = text, .end = text + length,
                                     .line_start = text, .line = 1};
    turner_tokens_advance(tokens);
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

void turner_tokens_advance(struct turner_tokens *tokens)
{
    const char *p = tokens->next, *end = tokens->end;
    bool comment = false;
    while (p < end && (comment || is_blank(*p) || *p == '#')) {
        if (*p == '\n') {
            tokens->line++;
            tokens->line_start = p + 1;
            comment = false;
        } else if (*p == '#') {
            comment = true;
        }
        p++;
    }
    const char *start = p;
    while (p < end && !is_blank(*p) && *p != '#')
        p++;
    tokens->last = tokens->token;
    tokens->token = (struct turner_token){start, (size_t)(p - start), tokens->line,
                                          (size_t)(start - tokens->line_start) + 1};
    tokens->next = p;
}

bool turner_tokens_at(const struct turner_tokens *tokens, const char *word)
{
    return tokens->token.length == strlen(word) &&
           memcmp(tokens->token.text, word, tokens->token.length) == 0;
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

bool turner_tokens_at_number(const struct turner_tokens *tokens)
{
    if (!tokens->token.length)
        return false;
    char c = tokens->token.text[0];
    return is_digit(c) || c == '+' || c == '-' || c == '.';
}

enum turner_result turner_tokens_number(struct turner_tokens *tokens, double *value,
                                        const char *what, double low, double high)
{
    const struct turner_token *token = &tokens->token;
    size_t read = turner_number_read(value, token->text, token->length);
    if (!read || read != token->length)
        return turner_tokens_expected(tokens, "a number, %s", what);
    if (fabs(*value) > (double)FLT_MAX)
        return turner_tokens_expected(tokens, "a number within ±3.4e38, %s", what);
    if (*value < low && isinf(high))
        return turner_tokens_expected(tokens, "at least %g, %s", low, what);
    if (*value < low || *value > high)
        return turner_tokens_expected(tokens, "%g to %g, %s", low, high, what);
    turner_tokens_advance(tokens);
    return TURNER_OK;
}

enum turner_result turner_tokens_integer(struct turner_tokens *tokens, int *value,
                                         const char *what, int low, int high)
{
    struct turner_tokens before = *tokens;
    double number;
    TURNER_TRY(turner_tokens_number(tokens, &number, what, low, high));
    if (number != floor(number))
        return turner_tokens_expected(&before, "a whole number, %s", what);
    *value = (int)number;
    return TURNER_OK;
}

enum turner_result turner_tokens_word(struct turner_tokens *tokens, const char *word)
{
    if (!turner_tokens_at(tokens, word))
        return turner_tokens_expected(tokens, "\"%s\"", word);
    turner_tokens_advance(tokens);
    return TURNER_OK;
}

enum turner_result turner_tokens_expected(const struct turner_tokens *tokens, const char *format,
                                          ...)
{
    char expected[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(expected, sizeof expected, format, arguments);
    va_end(arguments);
    const struct turner_token *token = &tokens->token;
    if (!token->length)
        return turner_tokens_fail(tokens, token, "expected %s, but the file ends here", expected);
    char shown[MAX_SHOWN_LENGTH + 1];
    size_t length = token->length < MAX_SHOWN_LENGTH ? token->length : MAX_SHOWN_LENGTH;
    for (size_t i = 0; i < length; i++)
        shown[i] = token->text[i] > ' ' && token->text[i] <= '~' ? token->text[i] : '?';
    shown[length] = '\0';
    return turner_tokens_fail(tokens, token, "expected %s, found \"%s%s\"", expected, shown,
                              length < token->length ? "…" : "");
}

enum turner_result turner_tokens_fail(const struct turner_tokens *tokens,
                                      const struct turner_token *token, const char *format, ...)
{
    char text[768];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return turner_fail(TURNER_BAD_INPUT, "%s:%zu:%zu: %s", tokens->path, token->line,
                       token->column, text);
}
