/* Status codes and the text that explains the last failure of this thread. */
#ifndef MOTE_CORE_STATUS_H
#define MOTE_CORE_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef enum mote_status {
    MOTE_OK = 0,
    MOTE_EINVAL, /* an input is wrong; the text says which, where, and what would be right */
    MOTE_ENOMEM, /* memory ran out */
    MOTE_EIO,    /* a file could not be read or written */
    MOTE_EUNSUPPORTED, /* the method cannot answer this, and gives no number instead */
    MOTE_ENUMERIC      /* a computation failed (singular system, no convergence) */
} mote_status;

/* A constant phrase for a code, for example "invalid input". Never NULL. */
const char *mote_status_text(mote_status status);

#if defined(__GNUC__)
#define MOTE_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define MOTE_PRINTF(text, first)
#endif

/* Remembers the text for this thread and returns status: `return mote_fail(MOTE_EINVAL, ...)`.
   The text holds 1,023 bytes; a longer one is cut. Any thread; no allocation. */
mote_status mote_fail(mote_status status, const char *format, ...) MOTE_PRINTF(2, 3);

/* The text of this thread's last mote_fail, or "" if there was none. Valid until the next one.
 */
const char *mote_error_text(void);

/* The status of this thread's last mote_fail, or MOTE_OK if there was none. */
mote_status mote_error_status(void);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
