/* Runs the mote program from a test: its exit status and its output. */
#ifndef MOTE_TESTS_PROGRAM_H
#define MOTE_TESTS_PROGRAM_H

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define PROGRAM_ARGUMENTS 40

/* Splits a line at its blanks into argv; line is changed. */
static inline void program_split(char *line, char *argv[PROGRAM_ARGUMENTS])
{
    static char program[] = MOTE_PROGRAM;
    int count = 0;
    argv[count++] = program;
    for (char *word = strtok(line, " "); word && count < PROGRAM_ARGUMENTS - 1;
         word = strtok(NULL, " "))
        argv[count++] = word;
    argv[count] = NULL;
}

/* Starts `mote LINE` with standard output and error redirected to a file. */
static inline pid_t program_start(const char *line, const char *file)
{
    pid_t pid = fork();
    if (pid != 0)
        return pid;
    char copy[2048];
    char *argv[PROGRAM_ARGUMENTS];
    (void)snprintf(copy, sizeof copy, "%s", line);
    program_split(copy, argv);
    int out = open(file, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (out >= 0 && dup2(out, STDOUT_FILENO) >= 0 && dup2(out, STDERR_FILENO) >= 0)
        (void)execv(argv[0], argv);
    _exit(127);
}

/* Its exit status, or -1 when a signal ended it. */
static inline int program_wait(pid_t pid)
{
    int status = 0;
    if (pid <= 0 || waitpid(pid, &status, 0) != pid || !WIFEXITED(status))
        return -1;
    return WEXITSTATUS(status);
}

/* A file's text, cut to size - 1 bytes. */
static inline void program_read(const char *path, char *text, size_t size)
{
    FILE *in = fopen(path, "r");
    size_t length = in ? fread(text, 1, size - 1, in) : 0;
    text[length] = '\0';
    if (in)
        (void)fclose(in);
}

#endif
