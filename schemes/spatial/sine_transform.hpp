// DST-I by FFTW (RODFT00): out_k = sum_{j=1}^{N-1} in_j sin(j k pi/N), in place on one buffer.
#pragma once

#include <vector>

namespace jvari {

class SineTransform {
public:
    explicit SineTransform(int intervals);  // N
    ~SineTransform();
    SineTransform(const SineTransform&) = delete;
    SineTransform& operator=(const SineTransform&) = delete;

    std::vector<double> buffer;  // element k-1 is k
    void operator()() noexcept;

private:
    void* plan_;
};

}  // namespace jvari
