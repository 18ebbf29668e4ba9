#define _DEFAULT_SOURCE /* syscall */
#include "harness/process/confine.h"

#include <linux/landlock.h>
#include <signal.h>
#include <stdint.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

/* Newer than the headers of Debian 12. */
#define ACCESS_TRUNCATE (UINT64_C(1) << 14)

/* Every handled kind of access that no rule allows is refused. */
static bool refuse_changes(void)
{
    const long version =
        syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION);
    if (version < 1)
        return false;
    struct landlock_ruleset_attr rules = {
        .handled_access_fs = LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
                             LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_CHAR |
                             LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
                             LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
                             LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM |
                             (version >= 3 ? ACCESS_TRUNCATE : 0)};
    const long file = syscall(SYS_landlock_create_ruleset, &rules, sizeof rules, 0);
    if (file < 0)
        return false;
    const bool done = syscall(SYS_landlock_restrict_self, (int)file, 0) == 0;
    (void)close((int)file);
    return done;
}

bool mote_confine(void)
{
    const struct rlimit nothing = {0, 0};
    (void)signal(SIGXFSZ, SIG_IGN); /* write then fails without a signal */
    (void)setrlimit(RLIMIT_FSIZE, &nothing);
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && refuse_changes();
}
