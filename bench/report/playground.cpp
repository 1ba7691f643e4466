#include "bench/report/playground.hpp"

#include <filesystem>

#include "bench/report/page_text.hpp"
#include "bench/store/base64.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/usage.hpp"
#include "scenes/installed.hpp"

namespace jvari::bench::report {

namespace fs = std::filesystem;

std::string playground() {
    std::error_code error;
    for (const fs::path& page : {installed("play.html"), fs::path(JVARI_SOURCE_PLAYGROUND)})
        if (fs::is_regular_file(page, error)) return store::read_whole(page);
    throw store::UsageError("the playground has not been built: " JVARI_SOURCE_PLAYGROUND " is missing. ./play builds it");
}

std::string with_playground(const std::string& report, const std::string& play) {
    const std::string added =
        std::string("<details class=\"part\" id=\"playground\"><summary><h2>The string in the page</h2></summary></details>\n") +
        "<script type=\"text/plain\" id=\"play\">" + store::base64(play) + "</script>\n<script>\n" + page_text("playground.js") +
        "</script>\n";
    std::string whole = report;
    return whole.insert(whole.rfind("</body>"), added);
}

}  // namespace jvari::bench::report
