// Loads a gcmc program, checks it, writes it for GRBL and draws the part, with Kerf's public headers alone.
#include <cstdio>

#include "kerf/kerf.h"

using namespace kerf;

int main(int argc, char** argv) {
  if (argc != 4) return std::fputs("usage: plate PROGRAM OUT.nc OUT.png\n", stderr), 2;
  Diagnostics diagnostics;
  LoadOptions reading;
  reading.program.defines = {"depth=3mm"};
  if (const auto job = load_job(argv[1], reading, diagnostics)) {
    for (const Finding& finding : check_job(*job, {}, diagnostics))
      std::printf("%s: %s\n", to_string(finding.origin).c_str(), finding.message.c_str());
    save_program(*job, "grbl", argv[2], {}, diagnostics);
    save_part(*job, {argv[3]}, {.run = {.resolution = mm(0.2)}, .files = {.view = *named_view("iso")}},
              diagnostics);
    const double minutes = times_of(*job, nullptr).estimate.all.total().seconds() / 60.0;
    std::printf("%zu steps, about %.1f minutes\n", job->program.path.size(), minutes);
  }
  for (const Diagnostic& message : diagnostics.list())
    std::fprintf(stderr, "%s\n", to_string(message).c_str());
  return diagnostics.has_errors() ? 1 : 0;
}
