#include "harness/command/shard.h"

#include "harness/base/file.h"
#include "harness/base/options.h"
#include "harness/command/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool mote_shard_read(const char *text, mote_shard *shard)
{
    uint64_t part, parts;
    char first[16];
    const char *slash = strchr(text, '/');
    if (!slash || (size_t)(slash - text) >= sizeof first)
        return false;
    memcpy(first, text, (size_t)(slash - text));
    first[slash - text] = '\0';
    if (!mote_read_unsigned(slash + 1, 1, UINT32_MAX, &parts) ||
        !mote_read_unsigned(first, 1, parts, &part))
        return false;
    *shard = (mote_shard){(uint32_t)part, (uint32_t)parts};
    return true;
}

bool mote_shard_of_task(const char *command, mote_shard *shard)
{
    const char *task = getenv("SLURM_ARRAY_TASK_ID");
    const char *count = getenv("SLURM_ARRAY_TASK_COUNT");
    if (shard->shards > 0 || (!task && !count))
        return true;
    char *text = mote_format("%s/%s", task ? task : "", count ? count : "");
    const bool read = mote_shard_read(text, shard);
    free(text);
    if (read)
        (void)fprintf(stderr, "shard %u/%u, from SLURM_ARRAY_TASK_ID and _COUNT\n",
                      shard->shard, shard->shards);
    else
        (void)mote_command_usage(command,
                                 "SLURM_ARRAY_TASK_ID=%s, SLURM_ARRAY_TASK_COUNT=%s: not task "
                                 "I of N with 1 <= I <= N; submit with --array=1-N, or give "
                                 "--shard I/N (1/1: everything)",
                                 task ? task : "(not set)", count ? count : "(not set)");
    return read;
}

size_t mote_shard_keep(mote_shard shard, const char **scenarios, size_t count)
{
    size_t kept = 0;
    if (shard.shards == 0)
        return count;
    for (size_t i = 0; i < count; ++i) {
        if (i % shard.shards == shard.shard - 1)
            scenarios[kept++] = scenarios[i];
    }
    return kept;
}
