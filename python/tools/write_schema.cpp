// Prints the schema of job files, from which the build makes the functions of kerf.op.
#include <cstdio>

#include "kerf/program/cut_job.h"

int main() { return std::fputs(kerf::cut_job_schema().c_str(), stdout) < 0; }
