// Conversion of arguments of several functions: programs, tools, stock, machines.
#pragma once

#include <optional>

#include "bindings.h"

#include "kerf/formats/measured.h"
#include "kerf/formats/printer_files.h"
#include "kerf/job/job.h"

namespace kerf::python {

/// A Program; a Toolpath becomes a program without tools and stock.
Program to_program(const pybind11::handle& value);
/// None, a Tool, a text such as "2=V d=12.7 angle=90", a ToolTable, or a sequence of them.
ToolChoices to_tool_choices(const pybind11::handle& value);
/// The tools, the stock (None, a Stock, or a text such as "100x60x12 at centre top") and the fixtures.
JobSettings to_settings(const pybind11::handle& tools, const pybind11::handle& stock,
                        const std::vector<std::pair<std::string, Stock>>& fixtures);
/// The name of a file from a str or os.PathLike; raises TypeError for others.
std::string to_file_name(const pybind11::handle& path);
/// None, or the path of a machine file.
std::optional<Machine> to_machine(const pybind11::handle& value);
/// None, or the name of a printer: "ender_3:PLA", "printer.toml".
std::optional<PrinterChoice> to_printer(const std::optional<std::string>& name);
/// None, or the work zero (x, y, z) in machine coordinates, mm, for logs of measured heights.
MeasuredOptions to_measured_options(const pybind11::handle& work_offset);
/// Maximum deviation of measured from expected heights, mm.
Length to_max_correction(double value);
/// Thickness of the board below the stock, mm.
Length to_spoilboard(double value);
/// None, or a text such as "d=40 length=100".
std::optional<RoundBar> to_bar(const pybind11::handle& value);
std::optional<Length> to_layer_height(const std::optional<double>& value);
/// 0 or above, mm.
Length to_resolution(double value);
unsigned to_threads(long long value);
/// A version of gcmc, or nothing; raises ValueError for others.
void check_compat(const std::string& compat);

}  // namespace kerf::python
