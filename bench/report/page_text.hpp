// The files of page/, which the build puts into the program: the page's frame, style and scripts, and its charts as Vega-Lite.
#pragma once

#include <span>

namespace jvari::bench::report {

struct PageText {
    const char *name, *text;  // "page.html", what it holds
};
std::span<const PageText> page_texts();

const char* page_text(const char* name);  // throws std::logic_error where there is no such file

}  // namespace jvari::bench::report
