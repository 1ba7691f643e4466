// |X|^2 of real rows: by FFTW in the program, by Eigen in the page's module
// (web/squared_transform.cpp).
#pragma once

#include <memory>
#include <span>

namespace jvari {

class SquaredTransform {
public:
    explicit SquaredTransform(int rows);
    ~SquaredTransform();
    SquaredTransform(const SquaredTransform&) = delete;
    SquaredTransform& operator=(const SquaredTransform&) = delete;

    std::span<double> rows();   // input of the transform
    void write(double* power);  // rows/2 + 1

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace jvari
