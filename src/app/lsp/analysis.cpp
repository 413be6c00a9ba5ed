// Reads the text of an editor, and adds up what each line does.
#include "app/lsp/analysis.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

#include "base/number.h"

#include "kerf/job/findings.h"
#include "kerf/path/report.h"

namespace kerf::app::lsp {
namespace {

constexpr auto kLongest = std::chrono::seconds(20);

/// Stops after some time, and where something newer waits.
class Deadline : public Progress {
 public:
  explicit Deadline(const std::function<bool()>& must_stop) : must_stop_(must_stop) {}
  void phase(std::string_view) override {}
  void report(double) override {}
  bool stop_requested() override {
    stopped_ = stopped_ || must_stop_() || std::chrono::steady_clock::now() > end_;
    return stopped_;
  }
  bool stopped() const { return stopped_; }

 private:
  const std::function<bool()>& must_stop_;
  std::chrono::steady_clock::time_point end_ = std::chrono::steady_clock::now() + kLongest;
  bool stopped_ = false;
};

/// The lines of this file that caused step `i`: its own, and those of the calls that led to it.
std::vector<std::uint32_t> lines_in(const Toolpath& path, std::size_t i, const std::string& file) {
  std::vector<std::uint32_t> lines;
  const auto add = [&](const Origin& origin) {
    const auto* text = std::get_if<TextLocation>(&origin);
    const bool is_here = text != nullptr && text->file == file && text->line > 0;
    if (is_here && std::find(lines.begin(), lines.end(), text->line) == lines.end())
      lines.push_back(text->line);
  };
  add(path.origin_of(i));
  for (const Origin& caller : path.origins().callers(path[i].origin())) add(caller);
  return lines;
}

void add_motion(LineWork& work, const Step& step, double length) {
  ++work.motions;
  (step.is_cutting() ? work.cut_mm : work.rapid_mm) += length;
  work.end = step.to();
  work.unknown_axes = step.unknown_axes();
  if (step.is_cutting()) work.feed = step.feed().mm_per_min();
}

/// Adds up the steps of each line.
void read_lines(const Toolpath& path, const std::string& file, Analysis& out) {
  const std::vector<float> seconds = reported_seconds(path, {});
  std::optional<int> tool;
  step::Spindle spindle;
  Point3 at;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& step = path[i];
    if (step.kind() == StepKind::tool_change) tool = step.tool_change().tool;
    if (step.kind() == StepKind::spindle) spindle = step.spindle();
    for (const std::uint32_t line : lines_in(path, i, file)) {
      const auto [found, is_new] = out.lines.try_emplace(line);
      LineWork& work = found->second;
      if (is_new) work.seconds_before = out.seconds;
      if (step.is_motion()) add_motion(work, step, length(step.to() - at));
      work.seconds += static_cast<double>(seconds[i]);
      work.tool = tool;
      work.spindle = spindle.turn;
      work.rpm = spindle.speed.rpm();
    }
    out.seconds += static_cast<double>(seconds[i]);
    if (step.is_motion()) at = step.to();
  }
}

std::string time_text(double seconds) {
  const auto whole = static_cast<long long>(seconds + 0.5);
  return seconds < 60.0 ? number_text(seconds, 1) + " s"
                        : fmt::format("{}:{:02} min", whole / 60, whole % 60);
}

}  // namespace

Analysis analyse(const std::string& path, const std::string& text, Depth depth,
                 const std::function<bool()>& must_stop) {
  Analysis out;
  Diagnostics diagnostics;
  std::vector<Finding> findings;
  Deadline deadline(must_stop);
  ProgramOptions options;
  options.unknown_diameter = UnknownDiameter::assume;
  auto program = load_program(InputFile::of_text(path, text), options, diagnostics, &deadline);
  if (program) {
    const Job job = make_job_or_print(std::move(*program), {}, UnknownTool::assume, diagnostics);
    read_lines(job.program.path, path, out);
    for (const auto& [number, tool] : job.tools.tools()) out.tools[number] = short_name(tool);
    if (depth == Depth::hazards && !deadline.stop_requested())
      findings = check_job(job, {}, diagnostics, &deadline);
  }
  out.is_stopped = deadline.stopped();
  out.annotations = annotations_of(findings, diagnostics, path);
  return out;
}

std::string text_of(const LineWork& work, const Analysis& analysis) {
  std::string text;
  if (work.motions > 0) {
    const auto axis = [&](unsigned n, double value) {
      return fmt::format(" {}{}", "XYZ"[n], (work.unknown_axes >> n & 1u) != 0 ? "?" : number_text(value, 4));
    };
    text += fmt::format("{} motion{}, to{}{}{}", work.motions, work.motions == 1 ? "" : "s",
                        axis(0, work.end.x), axis(1, work.end.y), axis(2, work.end.z));
    if (work.cut_mm > 0.0) text += fmt::format("  \n{} mm cut", number_text(work.cut_mm, 2));
    if (work.cut_mm > 0.0 && work.feed > 0.0) text += fmt::format(" at {} mm/min", number_text(work.feed, 1));
    if (work.rapid_mm > 0.0) text += fmt::format("  \n{} mm rapid", number_text(work.rapid_mm, 2));
  }
  if (work.tool) {
    const auto known = analysis.tools.find(*work.tool);
    text += fmt::format("{}tool {}{}", text.empty() ? "" : "  \n", *work.tool,
                        known == analysis.tools.end() ? "" : ": " + known->second);
  }
  if (work.spindle != SpindleTurn::off && work.rpm > 0.0)
    text += fmt::format("  \nspindle {} rpm", number_text(work.rpm, 0));
  text += fmt::format("{}{} after {} of {}", text.empty() ? "" : "  \n", time_text(work.seconds),
                      time_text(work.seconds_before), time_text(analysis.seconds));
  return text;
}

}  // namespace kerf::app::lsp
