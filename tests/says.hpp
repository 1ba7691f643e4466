// Whether a text says something; where it does not, the test shows the text.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace jvari {

inline testing::AssertionResult says(const std::string& text, const std::string& what) {
    if (text.find(what) != std::string::npos)
        return testing::AssertionSuccess() << "says " << what << ":\n" << text;
    return testing::AssertionFailure() << "does not say " << what << ":\n" << text;
}

}  // namespace jvari
