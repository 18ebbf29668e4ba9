#include "harness/process/manifest.h"

#include "harness/base/clock.h"
#include "harness/base/hash.h"
#include "harness/base/record.h"
#include "harness/process/huge_pages.h"
#include "harness/process/plugin.h"
#include "harness/process/spawn.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

#define PROGRAM_LIMIT ((size_t)1 << 30)

mote_status mote_program_hash(uint64_t *hash)
{
    /* /proc/self/exe is a link, but only a regular file can be read. */
    char path[4096];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (length <= 0)
        return mote_fail(MOTE_EIO, "/proc/self/exe: cannot be read; is /proc mounted?");
    path[length] = '\0';
    char *data = NULL;
    size_t size = 0;
    mote_status status = mote_file_read(path, PROGRAM_LIMIT, &data, &size);
    if (status != MOTE_OK)
        return status;
    *hash = mote_hash_bytes(MOTE_HASH_START, data, size);
    if (mote_plugin_path(0))
        *hash = mote_hash_word(*hash, mote_plugin_hash());
    free(data);
    return MOTE_OK;
}

void mote_manifest_program(const char *directory, char program[MOTE_PROGRAM_SIZE])
{
    json_t *manifest = NULL;
    program[0] = '\0';
    if (mote_record_read_json(directory, "manifest.json", &manifest) != MOTE_OK)
        return;
    const char *text = mote_text_at(manifest, "program");
    if (strlen(text) < MOTE_PROGRAM_SIZE)
        memcpy(program, text, strlen(text) + 1);
    json_decref(manifest);
}

/* The value of the line "KEY : VALUE" of a file in /proc; "" if there is none. */
static void proc_value(const char *path, const char *key, char *value, size_t size)
{
    value[0] = '\0';
    FILE *file = fopen(path, "r");
    if (!file)
        return;
    char line[1024];
    while (fgets(line, sizeof line, file)) {
        const char *after = line + strcspn(line, "\t:");
        if ((size_t)(after - line) != strlen(key) || strncmp(line, key, strlen(key)) != 0)
            continue;
        const char *start = after + strspn(after, " \t:");
        (void)snprintf(value, size, "%.*s", (int)strcspn(start, "\n"), start);
        break;
    }
    (void)fclose(file);
}

static json_t *text_or_null(const char *text)
{
    return text[0] ? json_string(text) : json_null();
}

/* The commit, and whether tracked files differ from it; null outside a clone. */
static void add_sources(json_t *object)
{
    static const char *const commit[] = {"git", "rev-parse", "HEAD", NULL};
    static const char *const dirty[] = {"git", "status", "--porcelain", "--untracked-files=no",
                                        NULL};
    char text[256] = "", changes[256] = "";
    bool known = mote_spawn(commit, MOTE_SOURCE_DIR, text, sizeof text) == MOTE_OK &&
                 mote_spawn(dirty, MOTE_SOURCE_DIR, changes, sizeof changes) == MOTE_OK;
    (void)json_object_set_new(object, "commit", known ? text_or_null(text) : json_null());
    (void)json_object_set_new(object, "dirty",
                              known ? json_boolean(changes[0] != '\0') : json_null());
}

void mote_machine_name(char *text, size_t size)
{
    char processor[MOTE_MACHINE_SIZE / 2];
    struct utsname system;
    proc_value("/proc/cpuinfo", "model name", processor, sizeof processor);
    (void)snprintf(text, size, "%.*s, %s", MOTE_MACHINE_SIZE / 3,
                   uname(&system) == 0 ? system.nodename : "", processor);
}

/* The processor's name and, where the system gives them, the numbers that distinguish
   processors of one name: virtual machines often show only a family's name. */
static void processor_name(char *text, size_t size)
{
    char name[128], family[16], model[16], stepping[16];
    proc_value("/proc/cpuinfo", "model name", name, sizeof name);
    proc_value("/proc/cpuinfo", "cpu family", family, sizeof family);
    proc_value("/proc/cpuinfo", "model", model, sizeof model);
    proc_value("/proc/cpuinfo", "stepping", stepping, sizeof stepping);
    if (family[0] && model[0])
        (void)snprintf(text, size, "%s, family %s, model %s, stepping %s", name, family, model,
                       stepping);
    else
        (void)snprintf(text, size, "%s", name);
}

static void add_machine(json_t *object)
{
    char processor[256], memory[64], machine[MOTE_MACHINE_SIZE];
    mote_machine_name(machine, sizeof machine);
    (void)json_object_set_new(object, "machine", json_string(machine));
    processor_name(processor, sizeof processor);
    proc_value("/proc/meminfo", "MemTotal", memory, sizeof memory);
    struct utsname system;
    const char *kernel = uname(&system) == 0 ? system.release : "";
    (void)json_object_set_new(object, "processor", text_or_null(processor));
    (void)json_object_set_new(object, "cores", json_integer(sysconf(_SC_NPROCESSORS_ONLN)));
    (void)json_object_set_new(object, "memory", text_or_null(memory));
    (void)json_object_set_new(object, "kernel", text_or_null(kernel));
    (void)json_object_set_new(object, "huge_pages", json_string(mote_huge_pages()));
}

static json_t *command_line(int argc, char **argv)
{
    json_t *array = json_array();
    for (int i = 0; i < argc; ++i)
        (void)json_array_append_new(array, json_string(argv[i]));
    return array;
}

/* The sessions so far, an empty array if there are none; the caller decrefs. */
static json_t *old_sessions(const char *directory)
{
    char *path = mote_format("%s/manifest.json", directory);
    json_t *old = NULL;
    if (access(path, F_OK) == 0 &&
        mote_record_read_json(directory, "manifest.json", &old) != MOTE_OK)
        old = NULL;
    free(path);
    json_t *sessions = json_object_get(old, "sessions");
    json_t *kept = json_is_array(sessions) ? json_incref(sessions) : json_array();
    json_decref(old);
    return kept;
}

mote_status mote_manifest_write(const char *directory, uint64_t program, uint64_t seed,
                                int argc, char **argv)
{
    char started[MOTE_CLOCK_DATE], hash[20];
    mote_clock_date(started);
    (void)snprintf(hash, sizeof hash, "%016" PRIx64, program);
    json_t *sessions = old_sessions(directory);
    char machine[MOTE_MACHINE_SIZE];
    mote_machine_name(machine, sizeof machine);
    json_t *session =
        json_pack("{s:s, s:s, s:I, s:s, s:o}", "started", started, "program", hash, "seed",
                  (json_int_t)seed, "machine", machine, "command", command_line(argc, argv));
    (void)json_array_append_new(sessions, session);
    json_t *object =
        json_pack("{s:i, s:s, s:s, s:s, s:s, s:s, s:s, s:I, s:o}", "schema", 1, "version",
                  MOTE_VERSION, "program", hash, "compiler", MOTE_COMPILER, "build_type",
                  MOTE_BUILD_TYPE, "flags", MOTE_FLAGS, "libraries", MOTE_LIBRARIES, "seed",
                  (json_int_t)seed, "sessions", sessions);
    add_sources(object);
    add_machine(object);
    if (mote_plugin_path(0))
        (void)json_object_set_new(object, "plugins", mote_plugin_json());
    return mote_record_json(directory, "manifest.json", object);
}
