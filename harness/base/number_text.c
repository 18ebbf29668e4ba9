#include "harness/base/number_text.h"

#include <stddef.h>
#include <stdio.h>

const char *mote_show_time(double ns, char text[MOTE_NUMBER_TEXT])
{
    static const struct {
        double above;
        const char *unit;
    } units[] = {{1e9, "s"}, {1e6, "ms"}, {1e3, "us"}, {0, "ns"}};
    if (ns != ns)
        return "-";
    size_t i = 0;
    while (units[i].above > 0 && ns < units[i].above * 0.9995)
        ++i;
    const double scaled = units[i].above > 0 ? ns / units[i].above : ns;
    const int digits = scaled < 9.995 && ns > 0 ? 2 : scaled < 99.95 && ns > 0 ? 1 : 0;
    (void)snprintf(text, MOTE_NUMBER_TEXT, "%.*f %s", digits, scaled, units[i].unit);
    return text;
}

const char *mote_show_ratio(double value, char text[MOTE_NUMBER_TEXT])
{
    if (value != value)
        return "-";
    int digits = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    (void)snprintf(text, MOTE_NUMBER_TEXT, "%.*f", digits, value);
    return text;
}

const char *mote_show_percent(double share, char text[MOTE_NUMBER_TEXT])
{
    if (share != share)
        return "-";
    (void)snprintf(text, MOTE_NUMBER_TEXT, "%.1f %%", 100 * share);
    return text;
}

const char *mote_show_error(double error, char text[MOTE_NUMBER_TEXT])
{
    if (error != error)
        return "-";
    (void)snprintf(text, MOTE_NUMBER_TEXT, "%.1e", error);
    return text;
}

const char *mote_show_count(double value, char text[MOTE_NUMBER_TEXT])
{
    if (value != value)
        return "-";
    (void)snprintf(text, MOTE_NUMBER_TEXT, "%.4g", value);
    return text;
}

const char *mote_show_bytes(double bytes, char text[MOTE_NUMBER_TEXT])
{
    if (bytes != bytes)
        return "-";
    if (bytes < 10e3)
        (void)snprintf(text, MOTE_NUMBER_TEXT, "%.0f B", bytes);
    else if (bytes < 10e6)
        (void)snprintf(text, MOTE_NUMBER_TEXT, "%.1f kB", bytes / 1e3);
    else
        (void)snprintf(text, MOTE_NUMBER_TEXT, "%.1f MB", bytes / 1e6);
    return text;
}

const char *mote_show_whole(double value, char text[MOTE_NUMBER_TEXT])
{
    char digits[MOTE_NUMBER_TEXT];
    int length = snprintf(digits, sizeof digits, "%.0f", value);
    if (length > 16)
        return mote_show_count(value, text);
    int used = 0;
    for (int i = 0; i < length; ++i) {
        if (i > 0 && (length - i) % 3 == 0)
            text[used++] = ',';
        text[used++] = digits[i];
    }
    text[used] = '\0';
    return text;
}

const char *mote_show_ordinal(uint32_t number, char text[MOTE_NUMBER_TEXT])
{
    static const char *const ends[] = {"th", "st", "nd", "rd"};
    const uint32_t last = number % 10, tens = number / 10 % 10;
    (void)snprintf(text, MOTE_NUMBER_TEXT, "%u%s", number,
                   ends[last < 4 && tens != 1 ? last : 0]);
    return text;
}
