#define _DEFAULT_SOURCE /* TIOCGWINSZ */
#include "harness/run/progress.h"

#include "harness/base/clock.h"

#include <stdio.h>
#include <sys/ioctl.h>
#include <unistd.h>

/* Seconds between two redraws of the moving line. */
#define MOVE_PAUSE 1.0

#define USUAL_WIDTH 80

static double seconds_now(void)
{
    return (double)mote_clock_ns() * 1e-9;
}

mote_progress mote_progress_begin(double pause)
{
    return (mote_progress){
        .terminal = isatty(STDERR_FILENO) == 1, .pause = pause, .last = seconds_now()};
}

/* Characters per line of the terminal, less the last one, which would wrap. */
static int line_width(void)
{
    struct winsize size;
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    return (known ? size.ws_col : USUAL_WIDTH) - 1;
}

bool mote_progress_is_due(const mote_progress *progress)
{
    if (!progress->terminal && progress->pause <= 0)
        return false;
    return seconds_now() >=
           progress->last + (progress->terminal ? MOVE_PAUSE : progress->pause);
}

static void draw(mote_progress *progress, const char *text)
{
    if (progress->terminal)
        (void)fprintf(stderr, "\r\033[K%.*s", line_width(), text);
    else
        (void)fprintf(stderr, "%s\n", text);
    progress->drawn = progress->terminal;
    progress->last = seconds_now();
}

void mote_progress_say(mote_progress *progress, const char *text)
{
    if (progress->terminal || mote_progress_is_due(progress))
        draw(progress, text);
}

void mote_progress_cell(mote_progress *progress, const char *text)
{
    if (progress->terminal || progress->pause <= 0 || mote_progress_is_due(progress))
        draw(progress, text);
}

void mote_progress_keep(mote_progress *progress, const char *text)
{
    mote_progress_end(progress);
    (void)fprintf(stderr, "%s\n", text);
    progress->last = seconds_now();
}

void mote_progress_precision(uint32_t replicates, double widest, double share)
{
    (void)fprintf(stderr, "after %u replicates the widest interval is +-%.2g %%%s\n",
                  replicates, 100 * widest,
                  widest <= share ? "" : ", wider than asked for: the budget ends");
}

void mote_progress_end(mote_progress *progress)
{
    if (progress->drawn)
        (void)fprintf(stderr, "\r\033[K");
    progress->drawn = false;
}
