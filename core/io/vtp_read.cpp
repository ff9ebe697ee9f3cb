#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <utility>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/base64.hpp>
#include <barchan/core/io/gzip.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/core/io/vtp.hpp>
#include <barchan/core/io/xml.hpp>

namespace barchan {
namespace {

constexpr const char* kOurs = "only files that barchan wrote are read";
constexpr std::size_t kMaxComponents = 64;

template <class Number>
Number number_from(std::string_view text, const char* what, const XmlReader& xml) {
  Number value{};
  text = trimmed(text);
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size()) {
    xml.fail(std::string(what) + " is " + in_quotes(text), "a number belongs here");
  }
  return value;
}

template <class Number>
std::vector<Number> numbers_from(std::string_view bytes, const XmlReader& xml) {
  if (bytes.size() % sizeof(Number) != 0)
    xml.fail("an array ends within a number", "the file is damaged");
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!bytes.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

/// The bytes of an inline array without the count in front of them.
std::string payload(std::string_view text, const XmlReader& xml) {
  std::optional<std::string> bytes = decode_base64(text);
  std::uint64_t size = 0;
  if (!bytes || bytes->size() < sizeof(size))
    xml.fail("an array is not base64", "the file is damaged");
  std::memcpy(&size, bytes->data(), sizeof(size));
  if (size != bytes->size() - sizeof(size))
    xml.fail("the length of an array differs from the one in its header", "the file is damaged");
  return bytes->substr(sizeof(size));
}

VtpColumn read_column(const XmlToken& tag, std::string_view text, const XmlReader& xml) {
  VtpColumn column;
  column.name = unescape_xml(tag.attribute("Name"));
  if (tag.attribute("format") != "binary") xml.fail("an array is not in format \"binary\"", kOurs);
  const auto components =
      number_from<std::size_t>(tag.attribute("NumberOfComponents"), "NumberOfComponents", xml);
  if (components < 1 || components > kMaxComponents)
    xml.fail("an array has too many components", kOurs);
  column.components = static_cast<int>(components);
  const std::string bytes = payload(text, xml);
  const std::string_view type = tag.attribute("type");
  if (type == "Float64") {
    column.values = numbers_from<double>(bytes, xml);
  } else if (type == "Int64") {
    column.values = numbers_from<std::int64_t>(bytes, xml);
  } else if (type == "Int32") {
    column.values = numbers_from<std::int32_t>(bytes, xml);
  } else {
    xml.fail("an array is of type " + in_quotes(type), kOurs);
  }
  return column;
}

/// Reads one piece; the enclosing tags say what an array is for.
class PieceReader {
 public:
  PieceReader(std::string_view text, const std::string& file) : xml_(text, file) {}

  VtpPiece read() {
    for (XmlToken token = xml_.next(); token.kind != XmlToken::Kind::End; token = xml_.next()) {
      if (token.kind != XmlToken::Kind::Open) continue;
      if (token.name == "VTKFile") check_file(token);
      if (token.name == "Piece") read_count(token);
      if (token.name == "FieldData" || token.name == "PointData" || token.name == "Points" ||
          token.name == "Verts" || token.name == "CellData" || token.name == "Lines") {
        parent_ = token.name;
      }
      if (token.name == "DataArray") read_array(token);
    }
    finish();
    return std::move(piece_);
  }

 private:
  void check_file(const XmlToken& tag) {
    is_polydata_ = tag.attribute("type") == "PolyData" &&
                   tag.attribute("byte_order") == "LittleEndian" &&
                   tag.attribute("header_type") == "UInt64" && tag.attribute("compressor").empty();
    if (!is_polydata_) xml_.fail("not an uncompressed little-endian PolyData file", kOurs);
  }

  void read_count(const XmlToken& tag) {
    if (has_piece_) xml_.fail("a second piece", kOurs);
    num_points_ =
        number_from<std::uint64_t>(tag.attribute("NumberOfPoints"), "NumberOfPoints", xml_);
    const std::string_view lines = tag.attribute("NumberOfLines");
    num_lines_ = lines.empty() ? 0 : number_from<std::uint64_t>(lines, "NumberOfLines", xml_);
    piece_.are_lines = num_lines_ > 0;
    has_piece_ = true;
  }

  void read_array(const XmlToken& tag) {
    const XmlToken content = xml_.next();
    const std::string_view text =
        content.kind == XmlToken::Kind::Text ? content.text : std::string_view();
    if (parent_ == "FieldData") {
      if (tag.attribute("Name") == "TimeValue")
        piece_.time = number_from<double>(text, "TimeValue", xml_);
      if (tag.attribute("Name") == "step")
        piece_.step = number_from<std::int64_t>(text, "step", xml_);
    } else if (parent_ == "Points") {
      VtpColumn points = read_column(tag, text, xml_);
      auto* values = std::get_if<std::vector<double>>(&points.values);
      if (values == nullptr || points.components != 3)
        xml_.fail("points are not three doubles each", kOurs);
      piece_.points = std::move(*values);
    } else if (parent_ == (piece_.are_lines ? "CellData" : "PointData")) {
      piece_.columns.push_back(read_column(tag, text, xml_));
    }
  }

  void finish() const {
    if (!is_polydata_ || !has_piece_) xml_.fail("no PolyData piece in the file", kOurs);
    if (piece_.points.size() / 3 != num_points_ || piece_.points.size() % 3 != 0) {
      xml_.fail("the number of points differs from NumberOfPoints", "the file is damaged");
    }
    if (piece_.are_lines && (num_points_ % 2 != 0 || num_points_ / 2 != num_lines_))
      xml_.fail("lines do not have two points each", kOurs);
    const std::uint64_t num_cells = piece_.are_lines ? num_lines_ : num_points_;
    for (const VtpColumn& column : piece_.columns) {
      const std::size_t size =
          std::visit([](const auto& values) { return values.size(); }, column.values);
      if (size / static_cast<std::size_t>(column.components) == num_cells &&
          size % static_cast<std::size_t>(column.components) == 0) {
        continue;
      }
      xml_.fail("array " + in_quotes(column.name) + " does not fit the number of points or lines",
                "the file is damaged");
    }
  }

  XmlReader xml_;
  VtpPiece piece_;
  std::string_view parent_;
  std::uint64_t num_points_ = 0, num_lines_ = 0;
  bool is_polydata_ = false;
  bool has_piece_ = false;
};

/// Calls `use` with every tag named `name`.
template <class Use>
void for_each_tag(std::string_view text, const std::string& file, std::string_view name, Use use) {
  XmlReader xml(text, file);
  for (XmlToken token = xml.next(); token.kind != XmlToken::Kind::End; token = xml.next()) {
    const bool is_tag = token.kind == XmlToken::Kind::Open || token.kind == XmlToken::Kind::Empty;
    if (is_tag && token.name == name) use(token, xml);
  }
}

}  // namespace

const VtpColumn* VtpPiece::find(std::string_view name) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

VtpPiece parse_vtp(std::string_view text, const std::string& file) {
  return PieceReader(text, file).read();
}

VtpPiece read_vtp(const std::string& path) {
  return parse_vtp(read_unpacked_file(path), path);
}

std::vector<std::string> read_pvtp(const std::string& path) {
  return parse_pvtp(read_unpacked_file(path), path);
}

std::vector<std::string> parse_pvtp(std::string_view text, const std::string& path) {
  std::vector<std::string> pieces;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for_each_tag(text, path, "Piece", [&](const XmlToken& tag, const XmlReader& xml) {
    if (tag.attribute("Source").empty()) xml.fail("a piece without Source", kOurs);
    pieces.push_back((folder / unescape_xml(tag.attribute("Source"))).string());
  });
  if (pieces.empty()) throw InputError(SourcePlace{path, 0, 0}, "names no pieces", kOurs);
  return pieces;
}

std::vector<PvdEntry> read_pvd(const std::string& path) {
  return parse_pvd(read_unpacked_file(path), path);
}

std::vector<PvdEntry> parse_pvd(std::string_view text, const std::string& file) {
  std::vector<PvdEntry> entries;
  for_each_tag(text, file, "DataSet", [&](const XmlToken& tag, const XmlReader& xml) {
    const std::string_view part = tag.attribute("part");
    entries.push_back({number_from<double>(tag.attribute("timestep"), "timestep", xml),
                       unescape_xml(tag.attribute("file")),
                       part.empty() ? 0 : number_from<int>(part, "part", xml)});
  });
  return entries;
}

}  // namespace barchan
