// Strings of the modal two-point scheme that go together, and how they do: kernels/company_kernel.hpp.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "schemes/modal/kernels/company_kernel.hpp"
#include "schemes/modal/kernels/modal_two_point_kernel.hpp"

namespace jvari {

class TwoPointCompany {
public:
    struct Member {
        TwoPoint* string;
        std::size_t place;  // among those that are advanced together
    };
    TwoPointCompany(std::vector<Member>, bool alike, const CompanyKernel&);

    // From where they are as at the last call, or from t = 0 where they have been reset since.
    void advance(std::span<Lane> all) noexcept;
    std::span<const Member> members() const { return members_; }
    TwoPointCompany(const TwoPointCompany&) = delete;

private:
    void begin() noexcept;

    std::vector<Member> members_;
    bool alike_;
    CompanyKernel kernel_;
    Company company_;
    std::vector<CompanyColumn> columns_;  // the taps of each member, then the energies
};

// Of strings with linear contact and the modes' own compliance those that are stepped faster together: as many as fill the widest vectors
// where they are alike but for their plucks' times and strengths, else three and four whose modes fit in the first-level cache.
// strings[i]: nullptr where it must go alone.
std::vector<std::unique_ptr<TwoPointCompany>> companies_of(std::span<TwoPoint* const> strings);

}  // namespace jvari
