// The options of the outputs: -o, --view, --size and --section.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/options/parser.h"
#include "app/report/status.h"
#include "base/system.h"

#include "kerf/job/outputs.h"
#include "kerf/job/posting.h"

namespace kerf::app {

/// The files of -o. For "-" there is a temporary file, which send() copies to standard output.
struct Outputs {
  std::vector<PartFile> files;
  std::string sent;  // path of the temporary file; empty: none
  TemporaryFolder folder;
};
/// Reads the names of -o; `to` is the ending of "-" without its point. Errors (an unknown ending, a name
/// twice, the name of an input) go to `usage`; a folder that is missing or not writable goes to
/// `diagnostics`.
Outputs read_outputs(const std::vector<std::string>& names, const std::string& to,
                     const std::vector<std::string>& inputs, Diagnostics& usage, Diagnostics& diagnostics);
/// The option --to of commands with add_outputs().
Option add_output_format(CommandParser& parser, std::string& to, const std::vector<std::string>& endings);
/// A warning for each given option that is for meshes, if there is none among the files.
void warn_without_mesh(const std::vector<Option>& options, const std::vector<PartFile>& files,
                       Diagnostics& diagnostics);
/// Ends a run: copies the temporary file of `outputs`, if there is one and `status` is done.
Status send(Console& console, Outputs outputs, Status status);

/// The post of --to; an unknown one is an error.
std::optional<PostTarget> post_named(const std::string& name, Diagnostics& usage);
/// A setup sheet as a drawing where the name of the output asks for one.
void choose_sheet_form(std::optional<PostTarget>& target, const std::string& out);
/// The post of the configuration; nothing if it names none.
std::optional<PostTarget> configured_post(Diagnostics& diagnostics);
/// An error if the output has the ending of program files and is none, or the other way round: they are read
/// by this ending.
void check_program_file(const std::optional<PostTarget>& target, const std::string& out, Diagnostics& usage);
/// "wrote    part.nc (120 lines)"
std::string text_of_written(const std::string& name, const PostedFile& file);

/// The view of a picture, as given.
struct PictureOptions {
  std::string view = "-35,50";     // "top", "iso" ... or "AZIMUTH,ELEVATION" in degrees
  std::string size = "1600x1000";  // pixels
  std::string section = "";        // "x=25"; empty: no section
};
Option add_section(CommandParser& parser, PictureOptions& options);
/// Nothing, with the error message in `problem`, if they are invalid.
std::optional<View> read_view(const PictureOptions& options, std::string& problem);

}  // namespace kerf::app
