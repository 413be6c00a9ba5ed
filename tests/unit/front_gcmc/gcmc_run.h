// Runs gcmc programs for tests: their messages, their text, their toolpath.
#pragma once

#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "front/gcmc/gcmc.h"

namespace kerf::test {

struct Ran {
  std::string text;                // what was written
  std::vector<std::string> lines;  // message lines without "file:line:col: "
  std::vector<Diagnostic> messages;
  GcmcRun run;
  Diagnostics diagnostics;
};

inline TextLocation location_of(const Diagnostic& message) { return std::get<TextLocation>(message.where); }

class Collector final : public GcmcOutput {
 public:
  explicit Collector(Ran& ran) : ran_(ran) {}
  void message(const Diagnostic& m) override {
    ran_.lines.push_back(gcmc_line(m).substr(to_string(m.where).size() + 2));
    ran_.messages.push_back(m);
  }
  void text(std::string_view piece) override { ran_.text += piece; }

 private:
  Ran& ran_;
};

inline GcmcOptions bare() {
  GcmcOptions options;
  options.file_name = "t.gcmc";
  options.frame = GcmcFrame::bare;
  options.precision = 3;
  options.want_text = true;
  return options;
}

inline Ran run(const std::string& program, const GcmcOptions& options = bare(),
               Progress* progress = nullptr) {
  Ran ran;
  Collector collector(ran);
  ran.run = run_gcmc(program, options, collector, ran.diagnostics, progress);
  return ran;
}

/// All messages of a program, joined by '|', those of message() without their head.
inline std::string output_of(const std::string& program, const GcmcOptions& options = bare()) {
  const std::string head = "Runtime message(): ";
  const Ran ran = run(program, options);
  std::string all;
  for (const std::string& line : ran.lines) {
    if (!all.empty()) all += "|";
    all += line.compare(0, head.size(), head) == 0 ? line.substr(head.size()) : line;
  }
  return all;
}

inline std::string value_of(const std::string& expression, const GcmcOptions& options = bare()) {
  return output_of("message(" + expression + ");", options);
}

/// All messages of a program, joined by '|'.
inline std::string messages_of(const std::string& program, const GcmcOptions& options = bare()) {
  const Ran ran = run(program, options);
  std::string all;
  for (const std::string& line : ran.lines) all += (all.empty() ? "" : "|") + line;
  return all;
}

/// An expression and its value, or a program and its messages: a row of the test tables.
struct Case {
  const char* given;
  const char* wanted;
};
class ValueTest : public testing::TestWithParam<Case> {
 protected:
  void expect_value() const { EXPECT_EQ(value_of(GetParam().given), GetParam().wanted); }
};
class MessageTest : public testing::TestWithParam<Case> {
 protected:
  void expect_messages() const { EXPECT_EQ(messages_of(GetParam().given), GetParam().wanted); }
};

}  // namespace kerf::test
