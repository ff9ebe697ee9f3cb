#include <barchan/app/report/page.hpp>

#include <filesystem>
#include <fstream>

#include <barchan/app/report/assets.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan::app {
namespace {

constexpr std::string_view kMark = "content=\"barchan report\"";  // in the first lines of a page

bool is_page(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(400, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(kMark) != std::string::npos;
}

/// JSON that no reader of HTML takes for the end of what it stands in.
std::string text_of(const PageData& data) {
  const std::string json = compact_text(data);
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      text += "\\u003c";
    else
      text.push_back(c);
  }
  return text;
}

}  // namespace

void write_page(const std::string& path, const PageData& data) {
  if (std::filesystem::exists(path) && !is_page(path))
    throw InputError(SourcePlace{path, 0, 0}, "exists and is no page of barchan",
                     "give another file by --out");
  OutputFile file(path);
  std::string_view rest = kPageFrame;
  const auto write_up_to = [&](std::string_view mark, std::string_view instead) {
    const auto at = rest.find(mark);
    file.write(rest.substr(0, at));
    file.write(instead);
    rest.remove_prefix(at + mark.size());
  };
  write_up_to("@STYLE@", kPageStyle);
  write_up_to("@DATA@", text_of(data));
  write_up_to("@SCRIPT@", kPageScript);
  file.write(rest);
  file.commit();
}

}  // namespace barchan::app
