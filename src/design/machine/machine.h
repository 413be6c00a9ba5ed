// What all commands of a design share: the toolpath, the position, the tool, feeds, stock, drawings, files.
//
// A position that was set without a motion is reached by a rapid, with a warning, before the next motion.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "design/call/call.h"
#include "design/machine/arguments.h"
#include "design/machine/outputs.h"
#include "design/machine/sketch.h"
#include "design/machine/tool_in_use.h"

#include "kerf/geom/geometry.h"
#include "kerf/geom/region.h"

namespace kerf::design {

inline constexpr double kFar = 1e-6;  // mm: positions closer than this are equal

enum class Mode : unsigned char { cut, print, no_preview };

/// Numbers of a printed bead.
struct PrintSettings {
  double feed = 0.0;                                                // mm/min; 0: that of the cuts
  double nozzle = 0.4, filament = 1.75, width = 0.6, height = 0.2;  // mm
};

/// Choices for files.
struct FileSettings {
  std::string post, ending;
  bool gcode = false, dxf = false;
  DxfVersion version = DxfVersion::r2000;
  enum class Layers : unsigned char { by_colour, by_tool, by_depth } layers = Layers::by_colour;
  Sketch::Chains chains = Sketch::Chains::joined;
  bool stagger = false;
};

/// Points of a polyline that commands collect.
struct OpenPolyline {
  std::vector<Point3> points = {};
  bool without_tool = false;
};

class Machine {
 public:
  explicit Machine(const MachineOptions& options);
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  // ---- the call that runs

  /// Sets the call whose location steps and messages have, as long as it lives.
  class Running {
   public:
    Running(Machine& state, Call& call);
    ~Running();
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

   private:
    Machine& state_;
    Call* before_;
    OriginId origin_before_;
  };
  void warn(std::string message);
  /// Warns where a command for one shape of tool runs with another one.
  void expect_tool(std::string_view shape, std::string_view command);
  /// Warns where the number of a tool is that of another one than the tool in use.
  void expect_number(int number);
  Diagnostics& diagnostics();
  Origin where();
  /// Ends the command if an error was reported since there were `errors`.
  void stop_after_errors(std::size_t errors);
  RegionOptions region_options();

  // ---- the object

  void start(Mode mode, bool gcode, bool dxf, double resolution);
  bool started() const { return started_; }
  Mode mode() const { return mode_; }

  // ---- position, mm

  Point3 position() const { return at_; }
  void set_axis(int axis, double value);

  // ---- motions

  void rapid(Point3 to);
  /// A rapid with the tool off: the beam of a laser is off in any case, a mill that turns passes above the
  /// material.
  void reposition(Point3 to);
  void rapid_xy(Point2 to) { rapid({to.x, to.y, at_.z}); }
  void rapid_z(double z) { rapid({at_.x, at_.y, z}); }
  void lift() { rapid_z(retract_height); }
  void move_to_safe_z();
  /// Nothing: the feed of the tool in use.
  void cut(Point3 to, std::optional<double> feed_given = {});
  void cut_at(Point2 to, double z) { cut({to.x, to.y, z}); }
  /// An arc from the present position, of less than a turn beyond `extra_turns`.
  void arc_to(Point3 to, Point2 centre, Turn turn, int extra_turns = 0);
  /// An arc between two angles in degrees, with a cut to its start if the tool is elsewhere.
  struct ArcBetween {
    Point2 centre;
    double radius = 0.0, start = 0.0, end = 0.0, rise = 0.0;
    Turn turn = Turn::ccw;
  };
  void arc(const ArcBetween& arc);
  void extrude(Point3 to, double volume, double width, double height, double feed_given);
  /// Filament drawn back where the nozzle is; mm3.
  void draw_back(double volume, double feed_given);
  /// Along a closed or open outline at a height, from where the tool is, which is its start.
  void follow(const Outline& outline, double z);
  /// From above into the start of each outline, along it, and up again.
  void cut_outlines(const std::vector<Outline>& outlines, double z);

  // ---- tools

  const ToolInUse& tool() const { return tool_; }
  const ToolNumbers& tool_numbers() const { return numbers_; }
  void change_tool(int number, double speed);
  /// For later changes to it; refused for a number that has cut.
  void add_tool(int number, Tool tool);
  /// Makes another tool of the one in use. After cuts it has a number of its own: those keep their tool.
  void describe_tool(Tool tool);
  /// Of the spindle, as of the last change of tools.
  double speed() const { return spindle_ ? spindle_->speed.rpm() : 0.0; }
  /// The beam of a laser during the following cuts; a power of 0: there is none.
  void set_beam(const step::LaserPower& beam);

  // ---- drawing

  void draw(int tool_number, Sketch::Entity entity);
  void set_colour(std::string_view name) { colour = drawing_colour(name); }
  std::string dxf() const;
  std::string svg() const;
  void forget_drawing() { sketch_ = {}; }
  void sketch_tools(const std::vector<int>& tools);
  std::map<int, Sketch>& tool_sketches() { return tool_sketches_; }
  std::string dxf_of(const Sketch& sketch, Point2 stagger = {}) const;

  // ---- texts and files

  void note(std::string_view text);
  /// The comments of the stock, three lines, which each file starts with; later ones replace the earlier.
  void note_stock(std::vector<std::string> lines);
  /// A step that moves nothing.
  template <class OtherStep>
  void add_step(const OtherStep& other) {
    path_->add(other, here());
  }
  /// A line of G-code: a comment in parentheses, or a line that is passed to the controller unchanged.
  void write_line(const std::string& line);
  void add_verbatim(const std::string& line);
  void write_further_lines(Moment moment);
  /// Replaces a file of the same name.
  void add_file(std::string name, std::string bytes);
  /// The steps of the file that is open: those after the end of the file before.
  Toolpath program() const;
  void open_program(std::string name);
  void close_program();
  bool has_outputs() const { return !files_.empty() || !programs_.empty(); }
  std::vector<DesignFile> take_files() { return std::exchange(files_, {}); }
  std::vector<DesignProgram> take_programs() { return std::exchange(programs_, {}); }
  /// The end of a program: up to the retract height, or everything off that a print has switched on.
  void end_program();
  /// A run of axes (bits) to their end switches.
  void home(unsigned axes);

  /// Forgets the motions: those before belong to another side of the part, or to nothing.
  void restart_path();
  /// The tool in use and its spindle, at the start of a new path.
  void keep_tool();
  /// The motions of a program instead of those so far; the position is where it ends.
  void continue_path(const Toolpath& program);

  const MachineOptions& options() const { return options_; }
  Results take();

  const Toolpath& path() const { return *path_; }
  /// The same; after restart_path() and continue_path() it is another one.
  const std::shared_ptr<Toolpath>& shared_path() const { return path_; }
  void set_path(std::shared_ptr<Toolpath> path) { path_ = std::move(path); }
  /// Where the next motion starts.
  Point3 start_of_moves() const { return commanded_.value_or(at_); }

  // What commands read and set; the invariants are theirs.
  std::map<std::string, double, std::less<>> ratios;  // of feeds, by class of tool
  double retract_height = 5.0, feed = 1600.0, plunge = 400.0;
  double resolution = 0.0;
  std::optional<double> rotary;  // degrees of A at the end of the following motions
  PrintSettings print;
  /// What liftandprimenozzle() has drawn back, mm3, until the next bead or unretract().
  struct Prime {
    double volume = 0.0, feed = 0.0;
  } prime;
  FileSettings settings;
  DrawingColour colour{"Black", 7};
  std::optional<std::string> layer;  // of the following entities; nothing: by `settings`
  /// The polyline that is being drawn; `without_tool`: its calls have no number of a tool.
  std::optional<OpenPolyline> polyline{};
  std::optional<Stock> stock;
  std::vector<Box3> blocks;                         // of which the stock consists
  std::optional<std::string> gcode_name, dxf_name;  // of the files that are open
  std::string tools_base;                           // of opendxffiles
  bool shown = false, debug = false;

 private:
  friend class Running;
  Call& call();
  OriginId here();
  Point2 stagger() const;
  void switch_beam(bool on);
  void replace_stock_notes(const std::vector<std::string>& lines);
  void mark_tool();
  void announce_tool(OriginId where);
  void catch_up();
  void arrive(Point3 to);
  void turn_with(std::size_t step);
  double feed_to(Point3 to, std::optional<double> given) const;
  std::string layer_for(int tool_number) const;

  /// The state at the end of a file, with which the next one starts.
  struct FileStart {
    std::size_t step = 0;
    std::optional<int> tool = {};
    std::optional<step::Spindle> spindle = {};
    std::optional<Point3> at = {};
  };

  MachineOptions options_;
  std::shared_ptr<Toolpath> path_ = std::make_shared<Toolpath>();
  Call* call_ = nullptr;
  OriginId origin_ = OriginId::none;  // of the call; none: not yet in the table
  bool started_ = false;
  Mode mode_ = Mode::no_preview;
  Point3 at_;                        // the position of the commands
  std::optional<Point3> commanded_;  // the end of the last motion; nothing before the first
  bool only_z_ = false;              // X and Y of it were never commanded
  ToolNumbers numbers_;
  ToolInUse tool_;
  bool tool_stated_ = false;  // the path has it
  std::set<int> used_;        // numbers of tools that have cut
  int last_used_ = -1;        // the one of `used_` that cut last
  std::optional<step::Spindle> spindle_;
  std::optional<step::LaserPower> beam_;
  bool beam_is_on_ = false;
  Sketch sketch_;
  std::map<int, Sketch> tool_sketches_;
  std::vector<std::string> stock_notes_;
  std::vector<std::size_t> stock_note_steps_;  // where the path has them
  FileStart file_, next_file_;                 // the file that is open, or was; and the one after it
  std::vector<DesignFile> files_;
  std::vector<DesignProgram> programs_;
};

}  // namespace kerf::design
