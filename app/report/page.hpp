#pragma once

#include <string>

#include <barchan/app/json_text.hpp>
#include <barchan/core/io/base64.hpp>

namespace barchan::app {

/// What a page shows; app/report/page reads it by these names:
///
///     title, about    texts
///     facts           [[label, text], ...]
///     view            particles: see particles_view.hpp
///     check           text
///     series          {columns, rows}
///     trace           see trace_window.hpp
///     run             run.json
///     sweep           json_of(RunTable) with axes, base, and links of runs
///     machine, deck   {name: value}
using PageData = Json;

/// Writes a page that needs nothing but itself. Replaces an earlier page, and no other file.
/// Errors: InputError where another file has the name; RunError.
void write_page(const std::string& path, const PageData& data);

/// Bytes as text for the page.
template <class Values>
[[nodiscard]] std::string encoded(const Values& values) {
  std::string text;
  Base64Encoder encoder;
  encoder.add({reinterpret_cast<const char*>(values.data()),
               values.size() * sizeof(typename Values::value_type)},
              text);
  encoder.finish(text);
  return text;
}

}  // namespace barchan::app
