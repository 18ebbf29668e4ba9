/* Any words, one a line, as words of a command line: methods with parameters, ranges, numbers,
   options. */
#include "harness/base/method_choice.h"
#include "harness/base/options.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 64 };

static void read_word(const char *word)
{
    mote_method_choice choice;
    uint64_t first, last;
    double real;
    if (mote_method_choice_read(word, &choice) == MOTE_OK)
        (void)mote_method_traits(choice.method, choice.values);
    (void)mote_read_range(word, 1000000, &first, &last);
    (void)mote_read_unsigned(word, 1, 1000, &first);
    (void)mote_read_real(word, -1e6, 1e6, &real);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text)
        return 0;
    memcpy(text, data, size);
    text[size] = '\0';
    char name[] = "fuzz";
    char *words[WORDS_MAX] = {name};
    int count = 1;
    char *rest = text;
    for (char *word; count < WORDS_MAX && (word = strtok_r(rest, "\n", &rest)) != NULL;) {
        read_word(word);
        words[count++] = word;
    }
    static const mote_option options[] = {
        {"out", "DIR", "A."}, {"json", NULL, "B."}, {"-o", "FILE", NULL}, {NULL, NULL, NULL}};
    mote_option_reader reader = mote_option_begin(options, count, words);
    const char *value;
    for (int option = 0; option != MOTE_OPTION_END && option != MOTE_OPTION_ERROR;)
        option = mote_option_next(&reader, &value);
    free(text);
    return 0;
}
