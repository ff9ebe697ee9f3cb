#include <barchan/core/io/xml.hpp>

#include <algorithm>
#include <utility>

#include <barchan/core/io/text_file.hpp>

namespace barchan {
namespace {

constexpr std::array<std::pair<std::string_view, char>, 4> kEntities = {
    {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}}};

}  // namespace

std::string_view XmlToken::attribute(std::string_view key) const {
  std::string_view rest = attributes;
  while (true) {
    const std::size_t equals = rest.find("=\"");
    if (equals == std::string_view::npos) return {};
    const std::string_view found = trimmed(rest.substr(0, equals));
    rest.remove_prefix(equals + 2);
    const std::size_t end = rest.find('"');
    if (end == std::string_view::npos) return {};
    if (found == key) return rest.substr(0, end);
    rest.remove_prefix(end + 1);
  }
}

void XmlReader::fail(const std::string& what, const std::string& remedy) const {
  const std::string_view before = text_.substr(0, std::min(at_, text_.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  throw InputError(SourcePlace{file_, line, 0}, what, remedy);
}

void XmlReader::skip_declarations() {
  while (true) {
    const std::string_view rest = text_.substr(at_);
    const bool is_comment = rest.starts_with("<!--");
    if (!is_comment && !rest.starts_with("<?") && !rest.starts_with("<!")) return;
    const std::string_view closing = is_comment ? "-->" : ">";
    const std::size_t end = rest.find(closing);
    if (end == std::string_view::npos)
      fail("a comment or declaration does not end", "the file is cut off");
    at_ += end + closing.size();
  }
}

XmlToken XmlReader::next() {
  skip_declarations();
  if (at_ >= text_.size()) {
    if (depth_ > 0)
      fail("<" + std::string(open_[depth_ - 1]) + "> is never closed", "the file is cut off");
    return {};
  }
  if (text_[at_] != '<') {
    const std::size_t end = std::min(text_.find('<', at_), text_.size());
    XmlToken token;
    token.kind = XmlToken::Kind::Text;
    token.text = text_.substr(at_, end - at_);
    at_ = end;
    return token;
  }
  const std::size_t end = text_.find('>', at_);
  if (end == std::string_view::npos) fail("a tag does not end", "the file is cut off");
  const std::string_view body = text_.substr(at_ + 1, end - at_ - 1);
  const XmlToken token = tag(body);
  at_ = end + 1;
  return token;
}

XmlToken XmlReader::tag(std::string_view body) {
  XmlToken token;
  token.kind = XmlToken::Kind::Open;
  if (body.ends_with('/')) {
    token.kind = XmlToken::Kind::Empty;
    body.remove_suffix(1);
  } else if (body.starts_with('/')) {
    token.kind = XmlToken::Kind::Close;
    body.remove_prefix(1);
  }
  token.name = take_word(body);
  token.attributes = body;
  if (token.name.empty()) fail("a tag without name", "is this an XML file?");
  if (token.kind == XmlToken::Kind::Open) {
    if (depth_ == kDeepest) fail("tags are nested too deeply", "is this a file of barchan?");
    open_[depth_++] = token.name;
  } else if (token.kind == XmlToken::Kind::Close) {
    if (depth_ == 0 || open_[depth_ - 1] != token.name)
      fail("</" + std::string(token.name.substr(0, 40)) + "> closes nothing",
           "tags must be nested");
    --depth_;
  }
  return token;
}

std::string escape_xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto found = std::find_if(kEntities.begin(), kEntities.end(),
                                    [&](const auto& e) { return e.second == c; });
    if (found == kEntities.end()) {
      out.push_back(c);
    } else {
      out.append(found->first);
    }
  }
  return out;
}

std::string unescape_xml(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const auto found = std::find_if(kEntities.begin(), kEntities.end(),
                                    [&](const auto& e) { return text.starts_with(e.first); });
    out.push_back(found == kEntities.end() ? text.front() : found->second);
    text.remove_prefix(found == kEntities.end() ? 1 : found->first.size());
  }
  return out;
}

}  // namespace barchan
