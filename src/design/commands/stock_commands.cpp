// The stock, and the part that is left of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/number.h"
#include "design/commands/rows.h"

#include "kerf/base/limits.h"
#include "kerf/stock/stock.h"

namespace kerf::design {
namespace {

constexpr int kDecimals = 4;  // of lengths in comments

/// The checked edges of a block.
Point3 block_size(Call& call) {
  Point3 size;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    size[axis] = positive(call.number(i), call.name(i));
    if (size[axis] > limits::kMaxStockSize)
      refuse(fmt::format("{} is at most {:g} mm", call.name(i), limits::kMaxStockSize));
  }
  return size;
}

Point3 corner(Call& call, std::size_t i) {
  const Point3 p = call.point3(i);
  return {coordinate(p.x, "X"), coordinate(p.y, "Y"), coordinate(p.z, "Z")};
}

/// A length in a comment: "0.00", "-12.7", "100", "50.0". A value that was computed has a decimal.
std::string length_text(double value, bool computed) {
  if (value == 0.0) return "0.00";
  std::string text = number_text(value, kDecimals);
  if (computed && text.find('.') == std::string::npos) text += ".0";
  return text;
}

/// stockMin, stockMax and STOCK/BLOCK, which simulators of other programs read.
void note_stock(Machine& machine, const Box3& block) {
  const Point3 low = block.low, high = block.high, size = high - low;
  const auto halved = [](double a, double b) { return a != 0.0 && b != 0.0; };
  const bool x = halved(low.x, high.x), y = halved(low.y, high.y);
  machine.note_stock(
      {fmt::format("stockMin:{}mm, {}mm, {}mm", length_text(low.x, x), length_text(low.y, y),
                   length_text(low.z, false)),
       fmt::format("stockMax:{}mm, {}mm, {}mm", length_text(high.x, x), length_text(high.y, y),
                   length_text(high.z, false)),
       fmt::format("STOCK/BLOCK, {}, {}, {}, {}, {}, {}", length_text(size.x, false),
                   length_text(size.y, false), length_text(size.z, false), length_text(-low.x, x),
                   length_text(-low.y, y), length_text(-low.z, false))});
}

void set_block(Machine& machine, const Stock& stock) {
  machine.stock = stock;
  machine.blocks = {stock.block};
}

const Stock& required_stock(const Machine& machine) {
  if (!machine.stock) refuse_now("setupstock must be called first");
  return *machine.stock;
}

void setupstock(Machine& machine, Call& call) {
  const Point3 size = block_size(call);
  const ZeroHeight height = zero_height(call.text(3));
  const ZeroCorner zero = zero_corner(call.text(4));
  auto retract = call.optional_number(5);
  if (!retract) retract = call.site().variable("retractheight");
  if (retract) machine.retract_height = positive(*retract, "retractheight");
  set_block(machine, make_block(size, zero, height));
  note_stock(machine, machine.stock->block);
}

void setupcuttingarea(Machine& machine, Call& call) {
  const Point3 size = block_size(call), low = corner(call, 3);
  machine.restart_path();
  for (int axis = 0; axis < 3; ++axis) machine.set_axis(axis, 0.0);
  Stock stock;
  stock.block = {low, low + size};
  set_block(machine, stock);
  machine.keep_tool();
  note_stock(machine, stock.block);
}

void shiftstock(Machine& machine, Call& call) {
  StockMove move;
  move.shift = corner(call, 0);
  machine.stock = moved(required_stock(machine), move);
  for (Box3& block : machine.blocks) block = {block.low + move.shift, block.high + move.shift};
  note_stock(machine, machine.stock->block);
}

/// The triangles of closed blocks.
struct Triangles {
  std::vector<double> positions;
  std::vector<std::uint32_t> corners;
  void add(const Box3& block) {
    // Corner i is high in X, Y, Z by its bits 1, 2, 4.
    constexpr std::uint32_t kFaces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                             {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                             {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    const auto first = static_cast<std::uint32_t>(positions.size() / 3);
    for (unsigned i = 0; i < 8; ++i)
      for (int axis = 0; axis < 3; ++axis)
        positions.push_back((i >> static_cast<unsigned>(axis) & 1u) != 0 ? block.high[axis]
                                                                         : block.low[axis]);
    for (const auto& face : kFaces)
      for (const std::uint32_t corner : face) corners.push_back(first + corner);
  }
};

void addtostock(Machine& machine, Call& call) {
  required_stock(machine);
  const Point3 size = block_size(call), low = corner(call, 3);
  if (machine.blocks.empty()) refuse_now("the stock does not consist of blocks");
  std::vector<Box3> blocks = machine.blocks;
  blocks.push_back({low, low + size});
  Triangles triangles;
  for (const Box3& block : blocks) triangles.add(block);
  const std::size_t errors = machine.diagnostics().errors();
  const auto body = make_mesh_body(triangles.positions, triangles.corners, "stock", machine.diagnostics());
  machine.stop_after_errors(errors);
  machine.stock = stock_of(body);
  machine.blocks = std::move(blocks);
  note_stock(machine, machine.stock->block);
}

void stockfromfile(Machine& machine, Call& call) {
  if (!machine.options().load_stock) refuse_now("stock cannot be read from files here");
  auto stock = machine.options().load_stock(call.text(0), machine.diagnostics());
  if (!stock) throw Reported{};
  machine.stock = std::move(stock);
  machine.blocks.clear();
}

/// Turns over what the cuts so far leave; the following ones are those of the second side.
void flipstock(Machine& machine, Call& call) {
  const Stock& stock = required_stock(machine);
  StockMove move;
  move.flip =
      choice(call.text(0), {"x", "y"}, "axis") == 0 ? StockMove::Flip::about_x : StockMove::Flip::about_y;
  move.across = call.optional_number(1);
  move.z = call.optional_number(2);
  if (machine.gcode_name) refuse_now("closegcodefile must be called first, for the first side");
  if (!machine.options().left_stock) refuse_now("the stock cannot be cut here, which turning it over needs");
  auto left = machine.options().left_stock(
      {machine.path(), stock, machine.tool_numbers().all(), mm(machine.resolution)}, machine.diagnostics());
  if (!left) throw Reported{};
  machine.stock = moved(*left, move);
  machine.blocks.clear();
  machine.restart_path();
  machine.keep_tool();
}

void previewgcodefile(Machine& machine, Call& call) {
  if (!machine.options().read_program) refuse_now("programs cannot be read from files here");
  auto program = machine.options().read_program(call.text(0), machine.diagnostics());
  if (!program) throw Reported{};
  for (auto& [number, tool] : program->tools) machine.add_tool(number, std::move(tool));
  if (program->stock) machine.stock = std::move(program->stock);
  machine.blocks.clear();
  machine.continue_path(program->path);
  machine.shown = true;
}

/// The simulation is run by what reads the program; this says that it is wanted.
void show_part(Machine& machine, Call&) {
  if (machine.mode() == Mode::no_preview) return;
  if (machine.mode() == Mode::cut) required_stock(machine);
  machine.shown = true;
}
void stockandtoolpaths(Machine& machine, Call& call) {
  const std::size_t option =
      choice(call.text(0), {"stockandtoolpaths", "stock", "toolpaths", "rapids"}, "option");
  if (option == 0) show_part(machine, call);
}

}  // namespace

void add_stock_commands(Rows& rows) {
  rows.push_back(
      row<setupstock>("setupstock",
                      "stockXwidth, stockYheight, stockZthickness, zeroheight=\"Top\", "
                      "stockzero=\"Lower-Left\", retractheight=undef",
                      "The stock: a block, the height of its zero (Top, Bottom) and its position (Lower-Left "
                      "... Top-\n"
                      "Right)."));
  rows.push_back(row<setupcuttingarea>(
      "setupcuttingarea", "sizeX, sizeY, sizeZ, extentleft, extentfb, extentd",
      "A block by its size and its lowest corner; the state is that before the first motion."));
  rows.push_back(row<shiftstock>("shiftstock", "shiftX, shiftY, shiftZ", "Move the stock, mm."));
  rows.push_back(row<addtostock>("addtostock",
                                 "stockXwidth, stockYheight, stockZthickness, shiftX=0, shiftY=0, shiftZ=0",
                                 "Add a further block with its lowest corner at the given position."));
  rows.push_back(row<stockfromfile>(
      "stockfromfile", "path",
      "The stock from a closed mesh (.stl .3mf .glb .obj) or from left-over stock (.kstock)."));
  rows.push_back(
      row<flipstock>("flipstock", "axis, across=undef, z=undef",
                     "Turn over what is left of the stock about an axis along 'x' or 'y'; the following cuts "
                     "are the\n"
                     "second side.\n"
                     "\n"
                     "The axis is that of the block's centre unless given, mm."));
  rows.push_back(row<previewgcodefile>(
      "previewgcodefile", "gc_file",
      "Read a G-code file, its stock and its tools, and show the part. Returns a Result."));
  rows.push_back(row<stockandtoolpaths>(
      "stockandtoolpaths", "option=\"stockandtoolpaths\"",
      "Show the part after all cuts, or the stock, the toolpaths or the rapids alone."));
  for (const char* name : {"returnstockandtoolpaths", "simulate"})
    rows.push_back(row<show_part>(name, "", "The part after all cuts."));
}

}  // namespace kerf::design
