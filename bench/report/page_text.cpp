#include "bench/report/page_text.hpp"

#include <cstring>
#include <stdexcept>
#include <string>

namespace jvari::bench::report {

const char* page_text(const char* name) {
    for (const PageText& t : page_texts())
        if (std::strcmp(t.name, name) == 0) return t.text;
    throw std::logic_error(std::string("no text of the page is called ") + name);
}

}  // namespace jvari::bench::report
