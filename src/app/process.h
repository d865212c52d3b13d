/* Other programs, run to their end. */
#ifndef TURNER_APP_PROCESS_H
#define TURNER_APP_PROCESS_H

/* Runs arguments[0], found in PATH, with those arguments (the last is NULL); its standard input and
 * output are the descriptors, or ours where they are -1. The exit status, 127 when there is no such
 * program, or -1 with errno when it could not be run or was killed (EINTR). */
int turner_process_run(char *const arguments[], int input, int output);

#endif
