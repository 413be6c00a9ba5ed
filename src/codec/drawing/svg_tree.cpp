// Reads XML into a tree of elements.
#if KERF_WITH_SVG
#include "codec/drawing/svg_tree.h"

#include <algorithm>
#include <expat.h>
#include <fmt/format.h>
#include <memory>

#include "base/codes/outline.h"

namespace kerf::svg {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 24;  // bytes passed to the parser at once

struct Builder {
  XML_Parser parser = nullptr;
  std::size_t max_depth = 0;
  std::vector<Element> open;  // the elements around the current position
  std::optional<Element> root;
  bool is_too_deep = false;
};

void start(void* data, const XML_Char* name, const XML_Char** attributes) {
  Builder& builder = *static_cast<Builder*>(data);
  if (builder.open.size() >= builder.max_depth) {
    builder.is_too_deep = true;
    XML_StopParser(builder.parser, XML_FALSE);
    return;
  }
  Element& element = builder.open.emplace_back();
  const std::string_view full = name;
  element.name = full.substr(0, 4) == "svg:" ? full.substr(4) : full;
  element.line = XML_GetCurrentLineNumber(builder.parser);
  for (const XML_Char** a = attributes; *a != nullptr; a += 2) element.attributes.emplace_back(a[0], a[1]);
}

void end(void* data, const XML_Char* /*name*/) {
  Builder& builder = *static_cast<Builder*>(data);
  if (builder.open.empty()) return;
  Element element = std::move(builder.open.back());
  builder.open.pop_back();
  if (builder.open.empty())
    builder.root = std::move(element);
  else
    builder.open.back().children.push_back(std::move(element));
}

void characters(void* data, const XML_Char* text, int count) {
  Builder& builder = *static_cast<Builder*>(data);
  if (!builder.open.empty() && builder.open.back().name == "style")
    builder.open.back().text.append(text, static_cast<std::size_t>(count));
}

}  // namespace

std::string_view Element::attribute(std::string_view key) const {
  for (const auto& [own, value] : attributes)
    if (own == key) return value;
  return {};
}

std::optional<Element> read_tree(std::string_view bytes, const std::string& file, std::size_t max_depth,
                                 Diagnostics& diagnostics) {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr),
                                                                            &XML_ParserFree);
  Builder builder;
  builder.parser = parser.get();
  builder.max_depth = max_depth;
  XML_SetUserData(parser.get(), &builder);
  XML_SetElementHandler(parser.get(), &start, &end);
  XML_SetCharacterDataHandler(parser.get(), &characters);
  XML_Status status = XML_STATUS_OK;
  do {
    const std::string_view block = bytes.substr(0, kBlock);
    bytes.remove_prefix(block.size());
    status = XML_Parse(parser.get(), block.data(), static_cast<int>(block.size()), bytes.empty() ? 1 : 0);
  } while (status == XML_STATUS_OK && !bytes.empty());
  if (status == XML_STATUS_OK && builder.root) return std::move(builder.root);
  const auto line = static_cast<std::uint32_t>(XML_GetCurrentLineNumber(parser.get()));
  diagnostics.error(codes::svg_xml, TextLocation{file, line, 0},
                    builder.is_too_deep ? fmt::format("elements are nested more than {} deep", max_depth)
                                        : fmt::format("not well-formed XML: {}",
                                                      XML_ErrorString(XML_GetErrorCode(parser.get()))));
  return std::nullopt;
}

}  // namespace kerf::svg
#endif
