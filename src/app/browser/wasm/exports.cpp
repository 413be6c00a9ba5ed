// The functions that the page's worker calls. An answer is a status as in HTTP and bytes, which stay valid
// until the next call.
#include <chrono>
#include <cstdint>
#include <emscripten.h>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "app/browser/workbench.h"
#include "base/file_names.h"

namespace {

using kerf::app::view::Workbench;

constexpr int kFound = 200, kNotNow = 204, kBad = 400, kNotFound = 404;
constexpr std::chrono::seconds kLimit{60};              // as in kerf view
constexpr std::chrono::milliseconds kReportEvery{100};  // of progress

// clang-format off
EM_JS(void, report_progress, (const char* phase, double fraction), {
  if (Module["progress"]) Module["progress"](UTF8ToString(phase), fraction);
});
// clang-format on

class Limited : public kerf::Progress {
 public:
  void phase(std::string_view what) override { phase_ = what; }
  void report(double fraction) override {
    const auto now = Clock::now();
    if (now < next_) return;
    next_ = now + kReportEvery;
    report_progress(phase_.c_str(), fraction);
  }
  bool stop_requested() override { return Clock::now() > end_; }

 private:
  using Clock = std::chrono::steady_clock;
  std::string phase_ = "reading";
  Clock::time_point end_ = Clock::now() + kLimit, next_ = Clock::now() + kReportEvery;
};

constexpr const char* kFolder = "/files";  // apart from the folders of emscripten's file system

Workbench& bench() {
  static Workbench made = [] {
    kerf::make_folders(kFolder);  // without the folder, files cannot be stored, which is reported
    kerf::enter_folder(kFolder);
    return Workbench("");
  }();
  return made;
}

std::string answer, answer_name;

int answered(std::string bytes, int status = kFound) {
  answer = std::move(bytes);
  return status;
}
int answered(const std::shared_ptr<const std::string>& bytes, int otherwise) {
  return bytes ? answered(*bytes) : answered("", otherwise);
}

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* kerf_answer() { return answer.data(); }
EMSCRIPTEN_KEEPALIVE std::size_t kerf_answer_size() { return answer.size(); }
/// The name of the file of the last download.
EMSCRIPTEN_KEEPALIVE const char* kerf_answer_name() { return answer_name.c_str(); }

EMSCRIPTEN_KEEPALIVE int kerf_put(const char* name, const char* bytes, std::size_t size) {
  const bool stored = bench().put(name, {bytes, size});
  return answered(bench().problem(), stored ? kFound : kBad);
}

/// The answer is the data of the event "model", or with status 400 of the event "errors".
EMSCRIPTEN_KEEPALIVE int kerf_load(const char* name) {
  Limited progress;
  const bool loaded = bench().load(name, &progress);
  return answered(bench().event(), loaded ? kFound : kBad);
}

EMSCRIPTEN_KEEPALIVE int kerf_model() { return answered(model_body(bench().shown())); }
EMSCRIPTEN_KEEPALIVE int kerf_mesh(std::uint32_t since) {
  const auto& shown = bench().shown();
  return answered(shown.tiles.changed_since(since, shown.revision));
}
EMSCRIPTEN_KEEPALIVE int kerf_path(std::uint32_t since) {
  return answered(bench().shown().path->body(since));
}
EMSCRIPTEN_KEEPALIVE int kerf_source(std::uint32_t id) {
  return answered(bench().shown().source_block(id), kNotFound);
}
EMSCRIPTEN_KEEPALIVE int kerf_exact() {
  Limited progress;
  if (!bench().shown().exact) bench().make_exact(&progress);
  return answered(bench().shown().exact, kNotNow);
}
EMSCRIPTEN_KEEPALIVE int kerf_at(std::uint32_t step, std::uint32_t from) {
  auto body = bench().at(step, from);
  return body ? answered(std::move(*body)) : answered("", kNotFound);
}

/// With status 404 the answer is the reason.
EMSCRIPTEN_KEEPALIVE int kerf_download(const char* format, const char* post, const char* view) {
  kerf::app::view::Download made = bench().download({format, post, view});
  answer_name = made.name;
  const bool is_made = made.problem.empty();
  return answered(is_made ? std::move(made.bytes) : std::move(made.problem), is_made ? kFound : kNotFound);
}

}  // extern "C"
