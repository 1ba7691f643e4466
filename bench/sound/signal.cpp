#include "bench/sound/signal.hpp"

#include <fmt/core.h>
#include <sndfile.h>

#include <memory>

#include "bench/store/usage.hpp"

namespace jvari::bench::sound {

Signal read_signal(const std::filesystem::path& path) {
    struct Close {
        void operator()(SNDFILE* f) const { sf_close(f); }
    };
    SF_INFO info{};
    const std::unique_ptr<SNDFILE, Close> file(sf_open(path.c_str(), SFM_READ, &info));
    if (!file) throw store::UsageError(fmt::format("{}: {}", path.string(), sf_strerror(nullptr)));
    if (info.channels != 1) throw store::UsageError(fmt::format("{}: has {} channels, expected one", path.string(), info.channels));
    Signal signal{static_cast<double>(info.samplerate), std::vector<double>(static_cast<std::size_t>(info.frames))};
    if (sf_readf_double(file.get(), signal.samples.data(), info.frames) != info.frames)
        throw store::UsageError(path.string() + ": ends before its time: the file is cut off");
    return signal;
}

}  // namespace jvari::bench::sound
