/* Runs files through a fuzz target, each once. Usage: fuzz_TARGET FILE... */
#include "tests/fuzz/fuzz.h"

#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    enum { ROOM = 1 << 20 };
    uint8_t *data = malloc(ROOM);
    for (int i = 1; i < argc && data; ++i) {
        FILE *file = fopen(argv[i], "rb");
        if (!file) {
            perror(argv[i]);
            return 1;
        }
        const size_t size = fread(data, 1, ROOM, file);
        (void)fclose(file);
        (void)LLVMFuzzerTestOneInput(data, size);
    }
    free(data);
    printf("%d inputs\n", argc - 1);
    return argc > 1 ? 0 : 1;
}
