#pragma once

#include <string_view>

// The files of app/report/page.

namespace barchan::app {

/// With @STYLE@, @DATA@ and @SCRIPT@ where these belong.
extern const std::string_view kPageFrame;
extern const std::string_view kPageStyle;
extern const std::string_view kPageScript;  ///< all scripts, one after the other

}  // namespace barchan::app
