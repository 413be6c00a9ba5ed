// The location of a command's call, as the command sees it.
#pragma once

#include "front/scad/run/interpreter.h"

namespace kerf::scad {

class Site final : public CallSite {
 public:
  Site(Interpreter& run, Position at, const Body* children, Context context)
      : run_(run), at_(at), children_(children), context_(context) {}
  TextLocation where() const override { return run_.locate(at_); }
  std::vector<DiagnosticNote> callers() const override { return run_.callers(); }
  OriginId origin(OriginTable& origins) override { return run_.origin(at_, origins); }
  Shape children() override;
  std::size_t child_count() const override { return children_ == nullptr ? 0 : children_->statements.size(); }
  Value variable(std::string_view name) const override { return run_.top_variable(name); }
  void print(std::string_view line) override { run_.print(line, at_); }
  Value call(const Value& function, const std::vector<Value>& arguments) override {
    return run_.call_value(function, arguments, at_);
  }
  bool ran_children() const { return ran_children_; }

 private:
  Interpreter& run_;
  Position at_;
  const Body* children_;
  Context context_;
  bool ran_children_ = false;
};

}  // namespace kerf::scad
