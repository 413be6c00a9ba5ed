// Any bytes as a job file of kerf cut: read, and its operations run on its shapes, with at most a few
// thousand steps each.
#include "kerf/program/cut_job.h"

#include <cstdint>
#include <string_view>

#include "kerf/formats/workshop_files.h"

namespace {

/// Stops long operations, as a user would.
class Stopping final : public kerf::Progress {
 public:
  void phase(std::string_view) override {}
  void report(double) override {}
  bool stop_requested() override { return ++asked_ > 2000; }

 private:
  int asked_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf;
  if (size > 4096) return 0;
  Diagnostics diagnostics;
  auto job = read_cut_job({reinterpret_cast<const char*>(data), size}, "fuzz.toml", diagnostics);
  if (!job) return 0;
  std::map<int, Tool> tools;
  for (const auto& [number, text] : job->tools)
    if (auto tool = read_tool_option(text, {}, diagnostics)) tools.emplace(number, std::move(*tool));
  std::vector<ArtShape> shapes = job->shapes;
  for (const TextShape& text : job->texts)
    if (!has_font_file(text) && text.text.size() < 100)
      if (auto made = shapes_of_text(text, {}, diagnostics))
        shapes.insert(shapes.end(), made->begin(), made->end());
  if (job->operations.size() > 4) job->operations.resize(4);
  for (CutOperation& operation : job->operations) operation.max_steps = 2000;
  Stopping progress;
  const SurfaceMesh* mesh = job->surface ? &job->surface->mesh : nullptr;
  compile_cut_job(*job, shapes, tools, diagnostics, &progress, mesh);
  return 0;
}
