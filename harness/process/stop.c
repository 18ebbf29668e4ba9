#include "harness/process/stop.h"

#include <signal.h>
#include <string.h>

static volatile sig_atomic_t stop_signal; /* 0: none received */

static void ask_to_stop(int signal_number)
{
    stop_signal = signal_number;
}

void mote_child_heed_signals(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = ask_to_stop;
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
    (void)signal(SIGXFSZ, SIG_IGN); /* write then fails, without a signal */
}

bool mote_child_stop_asked(void)
{
    return stop_signal != 0;
}

int mote_child_stop_signal(void)
{
    return stop_signal;
}

mote_status mote_child_stopped(const char *path)
{
    static const char said[] = "stopped by a signal; run the same command again";
    return path ? mote_fail(MOTE_EIO, "%s: %s", path, said)
                : mote_fail(MOTE_EIO, "%s to go on", said);
}
