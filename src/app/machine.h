/* What times are of. */
#ifndef TURNER_APP_MACHINE_H
#define TURNER_APP_MACHINE_H

#include <stddef.h>

/* The processor's name as the system has it; left as it is where that cannot be read. */
void turner_machine_cpu(char *cpu, size_t size);

#endif
