// Reads XML into a tree of elements.
#if KERF_WITH_SVG
#include "codec/drawing/svg_tree.h"

#include <algorithm>
#include <expat.h>
#include <fmt/format.h>
#include <map>
#include <memory>

#include "base/codes/outline.h"
#include "base/names.h"

namespace kerf::svg {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;  // bytes passed to the parser at once

constexpr std::string_view kSvg = "http://www.w3.org/2000/svg";

/// A declaration of a namespace: xmlns or xmlns:prefix.
struct Namespace {
  std::size_t depth = 0;
  std::string prefix;
  bool is_svg = false;
};

struct Builder {
  XML_Parser parser = nullptr;
  std::size_t max_depth = 0;
  std::vector<Element> open;  // the elements around the current position
  std::unique_ptr<Element> root;
  std::vector<Namespace> namespaces;
  std::vector<Element> sheets;
  std::size_t texts = 0;  // text elements around the current position
  bool is_too_deep = false;

  void locate(Element& element) const {
    element.line = XML_GetCurrentLineNumber(parser);
    element.column = XML_GetCurrentColumnNumber(parser) + 1;
  }
};

/// The name without the prefix of SVG's namespace. A prefix or default that is not declared is SVG's if it is
/// "svg" or none.
std::string local_name(const Builder& builder, std::string_view full) {
  const std::size_t colon = full.find(':');
  const std::string_view prefix = colon == std::string_view::npos ? "" : full.substr(0, colon);
  const std::string_view local = colon == std::string_view::npos ? full : full.substr(colon + 1);
  const auto declared = std::find_if(builder.namespaces.rbegin(), builder.namespaces.rend(),
                                     [&](const Namespace& n) { return n.prefix == prefix; });
  const bool is_svg =
      declared != builder.namespaces.rend() ? declared->is_svg : prefix.empty() || prefix == "svg";
  if (is_svg) return std::string(local);
  return prefix.empty() ? "?:" + std::string(local) : std::string(full);
}

/// Sets the parents, positions and numbers of all descendants.
void link_children(Element& element) {
  std::map<std::string_view, std::size_t> counts;  // by name
  std::size_t all = 0;
  for (std::size_t i = 0; i < element.children.size(); ++i) {
    Element& child = element.children[i];
    child.parent = &element;
    child.position = i;
    if (child.name != "#text") {
      child.number.at = ++all;
      child.number_of_name.at = ++counts[child.name];
    }
    link_children(child);
  }
  for (Element& child : element.children) {
    child.number.count = all;
    child.number_of_name.count = counts[child.name];
  }
}

void start(void* data, const XML_Char* name, const XML_Char** attributes) {
  Builder& builder = *static_cast<Builder*>(data);
  if (builder.open.size() >= builder.max_depth) {
    builder.is_too_deep = true;
    XML_StopParser(builder.parser, XML_FALSE);
    return;
  }
  Element& element = builder.open.emplace_back();
  builder.locate(element);
  for (const XML_Char** a = attributes; *a != nullptr; a += 2) {
    element.attributes.emplace_back(a[0], a[1]);
    const std::string_view key = a[0];
    if (key == "xmlns" || key.substr(0, 6) == "xmlns:")
      builder.namespaces.push_back({builder.open.size(),
                                    std::string(key.substr(std::min<std::size_t>(6, key.size()))),
                                    trim(std::string_view(a[1])) == kSvg});
  }
  element.name = local_name(builder, name);
  if (element.name == "text") ++builder.texts;
}

void end(void* data, const XML_Char* /*name*/) {
  Builder& builder = *static_cast<Builder*>(data);
  if (builder.open.empty()) return;
  Element element = std::move(builder.open.back());
  while (!builder.namespaces.empty() && builder.namespaces.back().depth == builder.open.size())
    builder.namespaces.pop_back();
  builder.open.pop_back();
  if (element.name == "text") --builder.texts;
  if (builder.open.empty())
    builder.root = std::make_unique<Element>(std::move(element));
  else
    builder.open.back().children.push_back(std::move(element));
}

void characters(void* data, const XML_Char* text, int count) {
  Builder& builder = *static_cast<Builder*>(data);
  if (builder.open.empty()) return;
  Element& around = builder.open.back();
  const std::string_view piece(text, static_cast<std::size_t>(count));
  if (around.name == "style") around.text.append(piece);
  if (builder.texts == 0) return;
  if (around.children.empty() || around.children.back().name != "#text") {
    Element& made = around.children.emplace_back();
    made.name = "#text";
    builder.locate(made);
  }
  around.children.back().text.append(piece);
}

void instruction(void* data, const XML_Char* name, const XML_Char* text) {
  Builder& builder = *static_cast<Builder*>(data);
  if (std::string_view(name) != "xml-stylesheet") return;
  Element& sheet = builder.sheets.emplace_back();
  sheet.text = text;
  builder.locate(sheet);
}

}  // namespace

std::string_view Element::attribute(std::string_view key) const {
  for (const auto& [own, value] : attributes)
    if (own == key) return value;
  return {};
}

bool Element::has(std::string_view key) const {
  return std::any_of(attributes.begin(), attributes.end(), [&](const auto& a) { return a.first == key; });
}

std::unique_ptr<Element> read_tree(std::string_view bytes, const TreeSource& source,
                                   std::vector<Element>& sheets, Pace& pace, Diagnostics& diagnostics) {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr),
                                                                            &XML_ParserFree);
  Builder builder;
  builder.parser = parser.get();
  builder.max_depth = source.max_depth;
  XML_SetUserData(parser.get(), &builder);
  XML_SetElementHandler(parser.get(), &start, &end);
  XML_SetCharacterDataHandler(parser.get(), &characters);
  XML_SetProcessingInstructionHandler(parser.get(), &instruction);
  XML_Status status = XML_STATUS_OK;
  const std::size_t all = bytes.size();
  do {
    if (pace.stops_at(all - bytes.size(), all)) return nullptr;
    const std::string_view block = bytes.substr(0, kBlock);
    bytes.remove_prefix(block.size());
    status = XML_Parse(parser.get(), block.data(), static_cast<int>(block.size()), bytes.empty() ? 1 : 0);
  } while (status == XML_STATUS_OK && !bytes.empty());
  if (status == XML_STATUS_OK && builder.root) {
    link_children(*builder.root);
    sheets = std::move(builder.sheets);
    return std::move(builder.root);
  }
  const auto line = static_cast<std::uint32_t>(XML_GetCurrentLineNumber(parser.get()));
  const auto column = static_cast<std::uint32_t>(XML_GetCurrentColumnNumber(parser.get()) + 1);
  diagnostics.error(
      codes::svg_xml, TextLocation{source.file, line, column},
      builder.is_too_deep
          ? fmt::format("elements are nested more than {} deep", source.max_depth)
          : fmt::format("not well-formed XML: {}", XML_ErrorString(XML_GetErrorCode(parser.get()))));
  return nullptr;
}

}  // namespace kerf::svg
#endif
