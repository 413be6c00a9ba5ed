// Comments with an effect: tools, stock, bead sizes, messages for the operator.
#include "front/gcode/run/program_comments.h"

#include <algorithm>
#include <fmt/format.h>
#include <string>

#include "base/codes/gcode.h"
#include "base/ending.h"
#include "front/gcode/comments/slicer_comments.h"

#include "kerf/op/level.h"

namespace kerf::gcode {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Case-insensitive; `word` is in capitals.
bool starts_with(std::string_view text, std::string_view word) {
  if (text.size() < word.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = text[i] >= 'a' && text[i] <= 'z' ? static_cast<char>(text[i] - 'a' + 'A') : text[i];
    if (c != word[i]) return false;
  }
  return true;
}

/// Comments that LinuxCNC carries out: log files and texts for the operator's screen.
bool acts_on_linuxcnc(std::string_view text) {
  for (const std::string_view word :
       {"LOGOPEN,", "LOGAPPEND,", "LOG,", "PROBEOPEN ", "DEBUG,", "PRINT,", "ABORT,"})
    if (starts_with(text, word)) return true;
  return text.size() < 11 && (starts_with(text, "LOGCLOSE") || starts_with(text, "PROBECLOSE"));
}

/// Whether a text names a parameter other than those of a probe, which posts do not write.
bool has_own_parameter(std::string_view text) {
  constexpr std::string_view kOfProbe = "#506";
  for (std::size_t at = text.find('#'); at != std::string_view::npos; at = text.find('#', at + 1))
    if (text.substr(at, kOfProbe.size()) != kOfProbe) return true;
  return false;
}

/// Whether a comment has this mark of Kerf's; it is in capitals from a post for a controller without small
/// letters.
bool has_mark(std::string_view text, std::string_view mark) {
  if (text.size() < mark.size()) return false;
  const auto is_same = [](char a, char b) { return a == b || a == capital_letter(b); };
  return std::search(text.begin(), text.end(), mark.begin(), mark.end(), is_same) != text.end();
}

/// Kerf's mark on a program whose heights are corrected: it is levelled, or measured values are applied, also
/// by kerf adjustz, whose comments are "==0.800+1.000*[#51-2.000]". Empty for other comments.
std::string_view mark_of(std::string_view text) {
  if (has_mark(text, kLevelledMark)) return kLevelledMark;
  if (has_mark(text, kCorrectedMark)) return kCorrectedMark;
  const bool is_formula = text.substr(0, 2) == "==" && text.find('#') != std::string_view::npos;
  return is_formula ? kCorrectedMark : std::string_view();
}

constexpr std::size_t kMaxPassedOn = 200;       // bytes
constexpr std::size_t kMaxCommentBytes = 1000;  // longer ones are skipped

constexpr std::size_t kMaxPendingComments = 1000;  // before the units are known

}  // namespace

bool CommentedBead::read(std::string_view text) {
  if (const auto size = read_bead_size(text)) {
    (size->measure == BeadMeasure::width ? width : height) = size->mm;
    return true;
  }
  const auto named = read_bead_kind(text);
  if (named) kind = *named;
  return named.has_value();
}

void ProgramComments::read(const Comment& comment, bool at_tool_change) {
  const std::string_view text = trimmed(comment.text);
  if (text.size() > kMaxCommentBytes) return;
  if (const std::string_view mark = mark_of(text); !mark.empty()) {
    if (mark != last_mark_) {
      steps_.start_origin(comment.column);
      add(step::Note{std::string(mark)});
    }
    last_mark_ = mark;
    return;
  }
  if (is_printer() && beads_.read(text)) return;
  const TextLocation where = reporter_.location(comment.column);
  if (const auto own = own_comments_.read(text, where, reporter_.diagnostics())) return use_own(*own, where);
  if (starts_with(text, "MSG")) {
    const std::string_view rest = trimmed(text.substr(3));
    if (rest.empty() || rest.front() != ',') return;
    steps_.start_origin(comment.column);
    const std::string_view message = trimmed(rest.substr(1));
    add(step::Note{std::string(message), NoteKind::message});
    return read_cam(message, where, at_tool_change);
  }
  if (program_.dialect == GcodeDialect::rs274 && comment.text.data()[-1] == '(' && acts_on_linuxcnc(text))
    return pass_on(text, comment.column);
  modes_.for_snapmaker = modes_.for_snapmaker || starts_with(text, "HEADER_TYPE:");
  if (starts_with(text, "STOCK") && !starts_with(text, "STOCK IS ")) {
    stock_.read(text, modes_.scale, where, reporter_.diagnostics());
    return;
  }
  if (starts_with(text, "TOOL/"))
    tool_comments_.read(text, modes_.scale, where, reporter_.diagnostics());
  else
    read_cam(text, where, at_tool_change);
}

/// Kerf's posts name the tool to change to before the pause for it, and the tool in the spindle at the start:
/// before the first motion that is no rapid.
void ProgramComments::use_own(const OwnComment& own, const TextLocation& where) {
  if (own.change_to) change_at_pause_ = own.change_to;
  modes_.zero_stays = modes_.zero_stays || own.zero_stays;
  if (!own.tool) return;
  tool_comments_.describe(*own.tool, ToolComments::Kind::own, where, reporter_.diagnostics());
  if (own.at_start || modes_.tool || change_at_pause_) return;
  for (const StepKind work : {StepKind::cut, StepKind::arc, StepKind::probe, StepKind::extrude})
    if (path_.has(work)) return;
  steps_.start_origin(0);
  change_tool(own.tool->number);
}

void ProgramComments::change_tool(int number) {
  add(step::ToolChange{number});
  modes_.tool = number;
  change_at_pause_.reset();
  tool_comments_.tool_change(number, reporter_.diagnostics());
  use_pending();
  changed_without_motion_ = !described_;
  if (described_) assign_description(number);
}

/// A comment that the controller carries out. Parameters that the program computes are not in posted
/// programs.
void ProgramComments::pass_on(std::string_view text, std::uint32_t column) {
  if (text.size() > kMaxPassedOn || has_own_parameter(text)) {
    reporter_.note(codes::code_ignored, column, "this comment, which LinuxCNC carries out, is not posted");
    return;
  }
  steps_.start_origin(column);
  add(step::Verbatim{fmt::format("({})", text)});
}

/// Comments in the header are kept until the units are known.
void ProgramComments::read_cam(std::string_view text, const TextLocation& where, bool at_tool_change) {
  if (is_printer()) return;
  if (units_given_ || moved_) return use_cam(text, where, at_tool_change);
  if (pending_.size() < kMaxPendingComments) pending_.push_back({std::string(text), where, at_tool_change});
}

void ProgramComments::use_pending() {
  for (const Pending& r : pending_) use_cam(r.text, r.where, r.at_tool_change);
  pending_.clear();
}

/// A comment without a number describes the tool of the last tool change if nothing moved since, else that of
/// the next one or of the next cut, whichever is first.
void ProgramComments::use_cam(std::string_view text, const TextLocation& where, bool at_tool_change) {
  cam_stock_comments_.read(text, modes_.scale);
  const std::optional<CamTool> tool = cam_comments_.read(text, modes_.scale, at_tool_change);
  if (!tool) return;
  const DescribedTool described{std::string(text), where, *tool};
  if (tool->number) return describe_tool(*tool->number, described);
  if (changed_without_motion_ && modes_.tool && !at_tool_change)
    return describe_tool(*modes_.tool, described);
  described_ = described;
}

/// Assigns the last comment without a number to a tool.
void ProgramComments::assign_description(int number) {
  const DescribedTool described = std::move(*described_);
  described_.reset();
  describe_tool(number, described);
}

/// TOOL/... comments (tool/tool_comments.h) and earlier comments have precedence.
void ProgramComments::describe_tool(int number, const DescribedTool& described) {
  if (!tool_comments_.describe(number, described.tool.shape, ToolComments::Kind::words, described.where,
                               reporter_.diagnostics()))
    return;
  const auto tool = program_.tools.find(number);
  tool->second.description = described.text;
  const std::string which = number == 0 && !modes_.tool ? "the tool" : fmt::format("tool {}", number);
  if (!described.tool.assumed.empty())
    reporter_.unusual_at(described.where, codes::tool_shape_assumed,
                         fmt::format("{} is {}", which, described.tool.assumed),
                         fmt::format("specify its shape, e.g. --tool {}=\"square d=6\"", number));
  reporter_.diagnostics().note(codes::tool_from_remark, described.where,
                               fmt::format("{} from this comment: {}, diameter {:g} mm", which,
                                           name_of(tool->second.shape), tool->second.diameter.mm()));
}

void ProgramComments::note_units() {
  units_given_ = true;
  use_pending();
}

void ProgramComments::finish() {
  use_pending();
  program_.units_given = units_given_;
  program_.stock = stock_.stock();
  if (!program_.stock) program_.stock = cam_stock_comments_.stock();
  tool_comments_.finish(reporter_.diagnostics());
}

}  // namespace kerf::gcode
