// Making the files of downloads.
#include "app/shown/downloads.h"

#include <optional>

#include "app/shown/burn.h"
#include "app/shown/file_name.h"
#include "base/file_names.h"
#include "job/named.h"

#include "kerf/job/outputs.h"
#include "kerf/job/posting.h"

namespace kerf::app::view {
namespace {

Download refused(std::string problem) { return {{}, {}, {}, std::move(problem)}; }

/// The first error as text.
Download failed(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == Severity::error) return refused(to_string(d));
  return refused("the file could not be made");
}

std::string name_of(const Shown& shown, std::string_view ending) {
  return download_name(stem_of(shown.job->program.source)) + std::string(ending);
}

std::string_view file_ending_of(const PostTarget& target) {
  if (target.is_program) return program_format().file_ending;
  if (target.native != nullptr) return target.native->file_ending;
  if (target.drawing != nullptr) return target.drawing->file_ending;
  return target.profile->file_ending;
}

/// The program for a target of kerf post.
Download posted(const Shown& shown, const std::string& post) {
  Diagnostics diagnostics;
  const auto target = offered_post(post.empty() ? "grbl" : post, shown.job->program.source, diagnostics);
  if (!target) return failed(diagnostics);
  PostingOptions how;
  how.machine = shown.inputs.program.machine;
  const auto files = post_program(program_of(*shown.job), *target, how, diagnostics);
  if (diagnostics.has_errors() || files.empty()) return failed(diagnostics);
  if (files.size() > 1) return refused("this post makes one file per tool; use kerf post");
  // A drawing or a page of a program's texts is saved, never shown with the rights of this address.
  const bool is_text = target->profile || target->native != nullptr;
  return {files.front().text,
          is_text ? "text/plain; charset=utf-8" : "application/octet-stream",
          name_of(shown, file_ending_of(*target)),
          {}};
}

Download of_surface(const Shown& shown, const DownloadRequest& request, unsigned threads) {
  const bool is_picture = request.format == "png";
  const auto format = mesh_format_of("part." + request.format);
  View view;
  if (const auto named = named_view(request.view)) view = *named;
  if (!request.view.empty() && !named_view(request.view)) return refused("unknown view");
  Diagnostics diagnostics;
  if (!shown.job->stock && shown.job->kind == JobKind::milling) {
    if (!is_picture) return refused("there is no part: nothing is removed");
    return {path_picture(*shown.job, view), "image/png", name_of(shown, ".png"), {}};
  }
  const auto run = run_job(*shown.job, {.threads = threads}, diagnostics);
  if (!run) return failed(diagnostics);
  const auto surface = make_surface(*shown.job, *run, {}, diagnostics);
  if (!surface) return failed(diagnostics);
  const auto bytes = is_picture ? picture_file(*surface, view, diagnostics)
                                : mesh_file(*surface, *format, name_of(shown, ""), diagnostics);
  if (!bytes || bytes->empty()) return failed(diagnostics);  // empty: this build has no such format
  return {*bytes,
          is_picture ? "image/png" : "application/octet-stream",
          name_of(shown, "." + request.format),
          {}};
}

/// For the page alone, which colours the board by it.
Download burn(const Shown& shown) {
  Diagnostics diagnostics;
  std::string bytes = burn_body(program_of(*shown.job).path, shown.inputs.burn, shown.revision, diagnostics);
  if (bytes.empty()) return failed(diagnostics);
  return {std::move(bytes), "application/octet-stream", name_of(shown, ".burn"), {}};
}

}  // namespace

Download make_download(const Shown& shown, const DownloadRequest& request, unsigned threads) {
  if (!shown.job) return refused("there is no part yet");
  if (request.format == "gcode") return posted(shown, request.post);
  if (request.format == "burn") return burn(shown);
  if (request.format != "png" && !mesh_format_of("part." + request.format))
    return refused("unknown format; there are stl, 3mf, glb, obj, png and gcode");
  return of_surface(shown, request, threads);
}

}  // namespace kerf::app::view
