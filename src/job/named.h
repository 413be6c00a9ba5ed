// Machines, posts, printers and materials by what a user calls them: a name in a folder of the configuration,
// a file, or a built-in name, in this order. Commands and job files ask here alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "job/configuration.h"

#include "kerf/base/diagnostics.h"
#include "kerf/formats/printer_files.h"
#include "kerf/job/posting.h"
#include "kerf/path/machine.h"
#include "kerf/program/cut_job.h"
#include "kerf/tool/material.h"

namespace kerf {

/// What a name is for; its folder in [folders].
enum class Named { machine, post, printer, material };

/// The text with the file that it names: that of a folder of `names`, else the one beside `user` (a job file)
/// if it is there; else the text itself, a built-in name or another file.
std::string located(Named what, const std::string& text, const Configuration& names,
                    const std::string& user = {});

/// Each is nothing, with errors, if there is none of the name or its file is invalid.
std::optional<Machine> machine_called(const std::string& text, Diagnostics& diagnostics,
                                      const Configuration& names = used_configuration());
std::optional<Material> material_called(const std::string& text, Diagnostics& diagnostics,
                                        const Configuration& names = used_configuration());
std::optional<PrinterChoice> printer_called(const std::string& text, Diagnostics& diagnostics,
                                            const Configuration& names = used_configuration());
std::optional<PostTarget> post_called(const std::string& text, Diagnostics& diagnostics,
                                      const Configuration& names = used_configuration());

/// The names of all targets for a program in a file: what post_called() takes, and the post files beside it
/// ("mill.toml"). Of those beside it only posts without errors.
std::vector<std::string> offered_posts(const std::string& program,
                                       const Configuration& names = used_configuration());
/// One of these; nothing, with an error, for another name, be it that of a file.
std::optional<PostTarget> offered_post(const std::string& name, const std::string& program,
                                       Diagnostics& diagnostics,
                                       const Configuration& names = used_configuration());

/// The values of the configuration for what a cutting job does not state.
CutDefaults cut_defaults(const Configuration& names = used_configuration());

/// An error at its line for each value that cannot hold: a number out of its range, a name that is unknown, a
/// folder or file that is missing.
void check_values(const Configuration& configuration, Diagnostics& diagnostics);

}  // namespace kerf
