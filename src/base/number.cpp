/* C++ has what C lacks: numbers that do not depend on the locale. It is also faster than strtod. */
#include "base/number.h"

#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

size_t turner_number_read(double *value, const char *text, size_t length)
{
    size_t plus = length > 1 && text[0] == '+' && text[1] != '-'; /* from_chars knows none */
    *value = 0;
    std::from_chars_result read = std::from_chars(text + plus, text + length, *value);
    if (!std::isfinite(*value)) /* "inf" and "nan" are numbers to it */
        return *value = 0, 0;
    if (read.ec == std::errc::invalid_argument)
        return 0;
    std::string_view number(text, (size_t)(read.ptr - text));
    if (number.size() > TURNER_NUMBER_LENGTH) /* so that only an exponent leads out of the range */
        return *value = 0, 0;
    if (read.ec == std::errc::result_out_of_range && number.find("e-") == number.npos &&
        number.find("E-") == number.npos)
        *value = number[0] == '-' ? -HUGE_VAL : HUGE_VAL;
    return number.size();
}
