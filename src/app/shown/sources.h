// The texts of a program's files: small ones whole, large ones in blocks of lines that a page asks for where
// it shows them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "job/record/record.h"

namespace kerf::app::view {

/// Whole lines of a text; of the last block also the empty one after its last line end.
struct SourceBlock {
  std::uint32_t id = 0;  // the same id: the same text
  std::uint32_t lines = 0;
  std::shared_ptr<const std::string> text;
};

struct SourceText {
  std::string path;
  std::optional<std::string> text;  // nothing for binary, unreadable and large files
  std::vector<SourceBlock> blocks;  // of a large one
  bool is_read = false;
};

inline constexpr std::size_t kWholeText = std::size_t{256} << 10;  // bytes; larger files are in blocks

/// A value: copies have the same texts.
class Sources {
 public:
  /// Reads files; those of more than `whole` bytes in blocks.
  void read(const std::vector<std::string>& files, std::size_t whole);
  /// Blocks with the same text as one of these get its id, others an id that these do not have.
  void take_ids(const std::vector<const Sources*>& before);

  const std::vector<SourceText>& files() const { return files_; }
  /// As /model has it.
  Record record() const;
  /// With the texts of large files up to a limit, for a page that cannot ask for blocks.
  Record record_with_texts() const;
  /// A block's text; null if there is none with this id.
  std::shared_ptr<const std::string> find(std::uint32_t id) const;

 private:
  std::uint32_t ids_ = 0;  // that have been given
  std::vector<SourceText> files_;
};

/// The lines of a text in blocks without ids. A line ends with LF, CR or both; what a page does not show of
/// very long ones is left out.
std::vector<SourceBlock> blocks_of_lines(std::string_view text);

}  // namespace kerf::app::view
