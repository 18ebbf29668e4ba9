#include "core/batch/batch_run.h"

mote_batch_options mote_default_batch_options(void)
{
    return (mote_batch_options){.budget = UINT64_MAX};
}
