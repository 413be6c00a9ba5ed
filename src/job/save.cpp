// A job from a file, and its results as files.
#include "kerf/job/save.h"

#include <fmt/format.h>
#include <utility>

#include "base/codes/files.h"
#include "base/codes/gcode.h"
#include "base/names.h"

#include "kerf/base/files.h"

namespace kerf {

std::optional<Job> load_job(const std::string& file, const LoadOptions& options, Diagnostics& diagnostics,
                            Progress* progress) {
  auto program = load_program(file, options.program, diagnostics, progress);
  if (!program || diagnostics.has_errors()) return std::nullopt;
  Job job = make_job_or_print(std::move(*program), options.job, options.unknown, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  return job;
}

bool save_part(const Job& job, const std::vector<std::string>& files, const SaveOptions& options,
               Diagnostics& diagnostics, Progress* progress) {
  std::vector<PartFile> parts;
  for (const std::string& file : files) {
    if (const auto part = part_file(file))
      parts.push_back(*part);
    else
      diagnostics.error(codes::output_kind_unknown, TextLocation{file, 0, 0},
                        "the ending belongs to no mesh, picture or left-over stock");
  }
  if (parts.size() != files.size() || !can_write(parts, job.kind, diagnostics)) return false;
  RunOptions how = options.run;
  how.volumes_by_tool = true;
  const auto run = run_job(job, how, diagnostics, progress);
  OutputSet set(job.program.files);
  return run && write_part(parts, job, *run, options.files, set, diagnostics, progress) &&
         set.commit(diagnostics);
}

bool save_program(const Program& program, std::string_view target, const std::string& file,
                  const PostingOptions& options, Diagnostics& diagnostics, Progress* progress) {
  const auto found = find_post_target(target);
  if (!found) {
    diagnostics
        .error(codes::post_unknown, CallLocation{"", 0, "save_program"},
               fmt::format("there is no controller or drawing format \"{}\"", clipped(target)))
        .hint = "there are: " + joined(post_target_names(), ", ");
    return false;
  }
  const std::vector<PostedFile> made = post_program(program, *found, options, diagnostics, progress);
  if (made.empty() || diagnostics.has_errors()) return false;
  OutputSet set(program.files);
  const std::vector<std::string> names = posted_file_names(file, made);
  for (std::size_t i = 0; i < made.size(); ++i)
    if (!set.write(names[i], made[i].text, diagnostics)) return false;
  return set.commit(diagnostics);
}

bool save_program(const Job& job, std::string_view target, const std::string& file,
                  const PostingOptions& options, Diagnostics& diagnostics, Progress* progress) {
  return save_program(program_of(job), target, file, options, diagnostics, progress);
}

}  // namespace kerf
