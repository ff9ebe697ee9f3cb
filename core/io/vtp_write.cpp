#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include <barchan/core/io/base64.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/core/io/vtp.hpp>
#include <barchan/core/io/xml.hpp>

namespace barchan {
namespace {

constexpr std::size_t kChunk = 3 << 18;
constexpr std::array<const char*, 3> kTypes = {"Float64", "Int64", "Int32"};

std::string_view bytes_of(const VtpValues& values) {
  return std::visit(
      [](auto span) {
        return std::string_view(reinterpret_cast<const char*>(span.data()), span.size_bytes());
      },
      values);
}

std::size_t size_of(const VtpValues& values) {
  return std::visit([](auto span) { return span.size(); }, values);
}

std::string array_tag(const VtpField& field) {
  return fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}")",
                     kTypes[field.values.index()], escape_xml(field.name), field.components);
}

/// A stream of bytes as base64 into a file, through a buffer of fixed size.
class Base64File {
 public:
  explicit Base64File(OutputFile& file) : file_(file) {}

  void add(std::string_view bytes) {
    while (!bytes.empty()) {
      const std::string_view part = bytes.substr(0, kChunk);
      encoder_.add(part, text_);
      flush();
      bytes.remove_prefix(part.size());
    }
  }

  void finish() {
    encoder_.finish(text_);
    flush();
  }

 private:
  void flush() {
    file_.write(text_);
    text_.clear();
  }

  OutputFile& file_;
  Base64Encoder encoder_;
  std::string text_;
};

void begin_array(OutputFile& file, const std::string& tag, std::uint64_t num_bytes,
                 Base64File& stream) {
  file.write(tag + " format=\"binary\">\n");
  stream.add({reinterpret_cast<const char*>(&num_bytes), sizeof(num_bytes)});
}

void end_array(OutputFile& file, Base64File& stream) {
  stream.finish();
  file.write("\n</DataArray>\n");
}

void write_array(OutputFile& file, const VtpField& field) {
  const std::string_view bytes = bytes_of(field.values);
  Base64File stream(file);
  begin_array(file, array_tag(field), bytes.size(), stream);
  stream.add(bytes);
  end_array(file, stream);
}

/// first, first + stride, ... as the vertices or lines of a piece need them.
void write_counting(OutputFile& file, const std::string& name, std::int64_t first,
                    std::int64_t stride, std::size_t count) {
  Base64File stream(file);
  begin_array(file, array_tag({name, 1, std::span<const std::int64_t>{}}), count * sizeof(first),
              stream);
  std::vector<std::int64_t> numbers(std::min<std::size_t>(count, 1 << 15));
  for (std::size_t done = 0; done < count; done += numbers.size()) {
    const std::size_t part = std::min(numbers.size(), count - done);
    for (std::size_t i = 0; i < part; ++i)
      numbers[i] = first + stride * static_cast<std::int64_t>(done + i);
    stream.add({reinterpret_cast<const char*>(numbers.data()), part * sizeof(first)});
  }
  end_array(file, stream);
}

void check(const VtpArrays& arrays, std::size_t num_cells) {
  if (arrays.points.size() != (arrays.are_lines ? 6 : 3) * num_cells)
    throw std::logic_error("vtp: points have three components, and lines two points");
  for (const VtpField& field : arrays.fields) {
    if (size_of(field.values) == num_cells * static_cast<std::size_t>(field.components)) continue;
    throw std::logic_error("vtp: the length of field " + field.name +
                           " does not fit the number of points or lines");
  }
}

constexpr const char* kHeader =
    "<?xml version=\"1.0\"?>\n"
    "<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n";

}  // namespace

void write_vtp(const std::string& path, const VtpArrays& arrays) {
  const std::size_t num_points = arrays.points.size() / 3;
  const std::size_t num_cells = arrays.are_lines ? num_points / 2 : num_points;
  const char* cells = arrays.are_lines ? "Lines" : "Verts";
  const char* data = arrays.are_lines ? "CellData" : "PointData";
  check(arrays, num_cells);
  OutputFile file(path);
  file.write(fmt::format(fmt::runtime(kHeader), "PolyData"));
  file.write("<PolyData>\n<FieldData>\n");
  file.write(fmt::format(
      "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{:.17g}"
      "</DataArray>\n<DataArray type=\"Int64\" Name=\"step\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{}</DataArray>\n</FieldData>\n",
      arrays.time, arrays.step));
  file.write(fmt::format(
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" "
      "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<{}>\n",
      num_points, arrays.are_lines ? 0 : num_cells, arrays.are_lines ? num_cells : 0, data));
  for (const VtpField& field : arrays.fields) write_array(file, field);
  file.write(fmt::format("</{}>\n<Points>\n", data));
  write_array(file, {"Points", 3, arrays.points});
  file.write(fmt::format("</Points>\n<{}>\n", cells));
  write_counting(file, "connectivity", 0, 1, num_points);
  const std::int64_t stride = arrays.are_lines ? 2 : 1;
  write_counting(file, "offsets", stride, stride, num_cells);
  file.write(fmt::format("</{}>\n", cells));
  file.write("</Piece>\n</PolyData>\n</VTKFile>\n");
  file.commit();
}

void write_pvtp(const std::string& path, std::span<const std::string> pieces,
                const VtpArrays& arrays) {
  OutputFile file(path);
  file.write(fmt::format(fmt::runtime(kHeader), "PPolyData"));
  const char* data = arrays.are_lines ? "PCellData" : "PPointData";
  file.write(fmt::format("<PPolyData GhostLevel=\"0\">\n<{}>\n", data));
  for (const VtpField& field : arrays.fields)
    file.write("<P" + array_tag(field).substr(1) + "/>\n");
  file.write(fmt::format("</{}>\n<PPoints>\n", data));
  file.write("<P" + array_tag({"Points", 3, arrays.points}).substr(1) + "/>\n</PPoints>\n");
  for (const std::string& piece : pieces)
    file.write("<Piece Source=\"" + escape_xml(piece) + "\"/>\n");
  file.write("</PPolyData>\n</VTKFile>\n");
  file.commit();
}

void write_pvd(const std::string& path, std::span<const PvdEntry> entries) {
  OutputFile file(path);
  file.write(fmt::format(fmt::runtime(kHeader), "Collection"));
  file.write("<Collection>\n");
  for (const PvdEntry& entry : entries) {
    file.write(fmt::format("<DataSet timestep=\"{:.17g}\" part=\"{}\" file=\"{}\"/>\n", entry.time,
                           entry.part, escape_xml(entry.file)));
  }
  file.write("</Collection>\n</VTKFile>\n");
  file.commit();
}

}  // namespace barchan
