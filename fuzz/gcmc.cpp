// Fuzz target: any text as a gcmc program, with limits that keep a run short.
#include "front/gcmc/gcmc.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "back/drawing/gcmc_drawing.h"

namespace {

class NullOutput final : public kerf::GcmcOutput {
 public:
  void message(const kerf::Diagnostic& m) override {
    if (++messages_ < 100) (void)kerf::gcmc_line(m);
    stop_ = messages_ > kMaxMessages;
  }
  void text(std::string_view) override {}
  bool too_talkative() const { return stop_; }

 private:
  static constexpr int kMaxMessages = 20'000;
  int messages_ = 0;
  bool stop_ = false;
};

class Patience final : public kerf::Progress {
 public:
  explicit Patience(const NullOutput& output) : output_(output) {}
  void phase(std::string_view) override {}
  void report(double) override {}
  bool stop_requested() override { return ++looks_ > 20 || output_.too_talkative(); }

 private:
  const NullOutput& output_;
  int looks_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kerf::GcmcOptions options;
  options.want_text = true;
  options.max_memory = std::size_t{16} << 20;
  options.max_path_steps = 20'000;
  options.max_calls = 300;
  if (size > 0) {  // the first byte selects the options
    options.imperial = (data[0] & 1) != 0;
    options.relative = (data[0] & 2) != 0;
    options.brief = (data[0] & 4) != 0;
    options.target = (data[0] & 8) != 0 ? kerf::GcmcTarget::svg : kerf::GcmcTarget::gcode;
    ++data, --size;
  }
  NullOutput output;
  Patience patience(output);
  kerf::Diagnostics diagnostics;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const kerf::GcmcRun run = kerf::run_gcmc(text, options, output, diagnostics, &patience);
  if (options.target == kerf::GcmcTarget::svg) {
    (void)kerf::gcmc_svg(run.path, {});
    (void)kerf::gcmc_dxf(run.path, {});
  }
  return 0;
}
