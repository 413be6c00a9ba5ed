// Loads a gcmc program, checks it, writes it for GRBL and draws the part, with Kerf's public headers alone.
#include <cstdio>

#include "kerf/job/findings.h"
#include "kerf/job/outputs.h"
#include "kerf/job/posting.h"

using namespace kerf;

int main(int argc, char** argv) {
  if (argc != 4) return std::fputs("usage: plate PROGRAM OUT.nc OUT.png\n", stderr), 2;
  Diagnostics diagnostics;
  auto program = load_program(argv[1], {.defines = {"depth=3mm"}}, diagnostics);
  if (program && !diagnostics.has_errors()) {
    const Job job = make_job(std::move(*program), {}, UnknownTool::error, diagnostics);
    for (const Finding& finding : check_job(job, {}, diagnostics))
      std::printf("%s: %s\n", to_string(finding.origin).c_str(), finding.message.c_str());
    const auto gcode = post_program(job.program, *find_post_target("grbl"), {}, diagnostics);
    const auto run = run_job(job, {.resolution = mm(0.2)}, diagnostics);
    OutputSet files(job.program.files);
    if (run && files.write(argv[2], gcode.front().text, diagnostics) &&
        write_part({*part_file(argv[3])}, job, *run, {.view = *named_view("iso")}, files, diagnostics))
      files.commit(diagnostics);
    const double minutes = times_of(job, nullptr).estimate.all.total().seconds() / 60.0;
    std::printf("%zu steps, about %.1f minutes\n", job.program.path.size(), minutes);
  }
  for (const Diagnostic& message : diagnostics.list())
    std::fprintf(stderr, "%s\n", to_string(message).c_str());
  return diagnostics.has_errors() ? 1 : 0;
}
