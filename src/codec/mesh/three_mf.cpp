// Writes 3MF: a zip of XML parts. The model is compressed as it is written; colours are base materials, which
// all readers support. Dates are fixed, so that the same mesh gives the same bytes.
#if KERF_WITH_3MF

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

#include "base/markup.h"
#include "codec/mesh/writers.h"
#include "codec/zip/zip.h"

namespace kerf::mesh_format {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16;

class ModelWriter {
 public:
  explicit ModelWriter(zip::Writer& package) : package_(package) { text_.reserve(kPiece + 4096); }
  ~ModelWriter() { package_.write(text_); }
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    if (text_.size() < kPiece) return;
    package_.write(text_);
    text_.clear();
  }

 private:
  zip::Writer& package_;
  std::string text_;
};

void write_model(ModelWriter&& out, const MeshView& mesh) {
  const bool coloured = !mesh.palette.empty() && !mesh.colour_index.empty();
  out.add(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
      "<metadata name=\"Application\">Kerf</metadata>\n<resources>\n");
  if (coloured) {
    out.add("<basematerials id=\"2\">\n");
    for (std::size_t k = 0; k < mesh.palette.size(); ++k) {
      const auto& c = mesh.palette[k];
      out.add("<base name=\"{}\" displaycolor=\"#{:02X}{:02X}{:02X}\"/>\n", markup_text(colour_name(mesh, k)),
              c[0], c[1], c[2]);
    }
    out.add("</basematerials>\n");
  }
  out.add("<object id=\"1\" type=\"model\" name=\"{}\"{}>\n<mesh>\n<vertices>\n",
          markup_text(plain_name(mesh)), coloured ? " pid=\"2\" pindex=\"0\"" : "");
  for (std::size_t v = 0; v < vertex_count(mesh); ++v) {
    const float* p = mesh.positions.data() + 3 * v;
    out.add("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", p[0], p[1], p[2]);
  }
  out.add("</vertices>\n<triangles>\n");
  for (std::size_t t = 0; t < triangle_count(mesh); ++t) {
    const std::uint32_t* i = mesh.triangles.data() + 3 * t;
    const std::size_t colour = colour_of(mesh, t);
    if (coloured && colour != 0 && colour < mesh.palette.size()) {
      out.add("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\" pid=\"2\" p1=\"{}\"/>\n", i[0], i[1], i[2], colour);
    } else {
      out.add("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", i[0], i[1], i[2]);
    }
  }
  out.add(
      "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item "
      "objectid=\"1\"/>\n</build>\n</model>\n");
}

constexpr std::string_view kContentTypes =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n"
    "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n"
    "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\n"
    "</Types>\n";
constexpr std::string_view kRelations =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>\n"
    "</Relationships>\n";

}  // namespace

std::string write_three_mf(const MeshView& mesh) {
  zip::Writer package;
  package.begin("[Content_Types].xml");
  package.write(kContentTypes);
  package.end();
  package.begin("_rels/.rels");
  package.write(kRelations);
  package.end();
  // A line of the model has at most 100 bytes.
  const bool large = (vertex_count(mesh) + triangle_count(mesh)) > (std::size_t{1} << 32) / 100;
  package.begin("3D/3dmodel.model", large ? zip::Writer::Size::large : zip::Writer::Size::small);
  write_model(ModelWriter(package), mesh);
  package.end();
  return package.finish();
}

}  // namespace kerf::mesh_format

#endif
