// SPDX-License-Identifier: GPL-2.0-or-later
// Every pin, parameter and function that a module exports is named in its manual page.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "components/test/bench.hh"
#include "components/test/modules.hh"

namespace mw::components::test {
namespace {

/// The page that describes a module: its own, or that of the module with the same source.
std::string page_of(const std::string &module) {
    static const std::map<std::string, std::string> SHARED = {{"abs_s32", "abs"},
                                                              {"abs_s64", "abs"},
                                                              {"tristate_float", "tristate_bit"},
                                                              {"momentary2nist", "toggle2nist"},
                                                              {"tof", "ton"},
                                                              {"at_pid", "pid"}};
    const auto found = SHARED.find(module);
    if (found != SHARED.end()) {
        return found->second;
    }
    return module.rfind("conv_", 0) == 0 ? "conv" : module;
}

/// The bold words on a page.
std::set<std::string> bold_words(const std::string &page) {
    for (const auto &folder : std::filesystem::directory_iterator(MW_COMPONENTS_FOLDER)) {
        std::ifstream file(folder.path() / "man" / (page + ".9.scd"));
        if (!file) {
            continue;
        }
        const std::string text(std::istreambuf_iterator<char>(file), {});
        std::set<std::string> words;
        std::string word;
        bool is_bold = false;
        for (std::size_t i = 0; i < text.size(); ++i) {
            const bool escaped = text[i] == '\\' && i + 1 < text.size();
            if (text[i] == '*') {
                if (is_bold) {
                    words.insert(word);
                }
                is_bold = !is_bold;
                word.clear();
            } else {
                i += escaped ? 1 : 0;
                word += text[i];
            }
        }
        return words;
    }
    return {};
}

/// True when `name` matches `pattern`: numbers replace its index letters (N, M, MM, FROM-TO and so on), and
/// the letter of an axis replaces L.
bool isNamed(const std::string &pattern, const std::string &name) {
    std::size_t p = 0;
    std::size_t n = 0;
    const auto is_upper = [&](std::size_t at) {
        return at < pattern.size() && std::isupper(static_cast<unsigned char>(pattern[at])) != 0;
    };
    const auto is_digit = [&](std::size_t at) {
        return at < name.size() && std::isdigit(static_cast<unsigned char>(name[at])) != 0;
    };
    while (p < pattern.size() && n < name.size()) {
        const bool is_axis = p < pattern.size() && pattern[p] == 'L' && n < name.size() &&
                             std::string_view("xyzabcuvw").find(name[n]) != std::string_view::npos;
        if (is_axis) {
            ++p;
            ++n;
        } else if (is_upper(p) && is_digit(n)) {
            while (is_upper(p)) {
                ++p;
            }
            while (is_digit(n)) {
                ++n;
            }
        } else if (pattern[p++] != name[n++]) {
            return false;
        }
    }
    return p == pattern.size() && n == name.size();
}

class ManPage : public ::testing::TestWithParam<std::string> {};

TEST_P(ManPage, NamesEverythingThatTheModuleExports) {
    const std::string &module = GetParam();
    const std::set<std::string> words = bold_words(page_of(module));
    ASSERT_FALSE(words.empty()) << "no page " << page_of(module) << ".9.scd";
    if (module == "threads") {
        return;  // every bench has loaded it; it exports only threads
    }
    const bool is_motion = module == "motmod";
    Bench bench(is_motion ? "loadrt trivkins\nloadrt tpmod\nloadrt homemod" : "");
    bench.run("loadrt " + module + " " + arguments_of(module));
    ASSERT_EQ(bench.output.errors, "");
    const auto expect_named = [&](std::string name) {
        if (module.rfind("conv_", 0) == 0) {
            name.replace(0, name.find('.'), "conv-FROM-TO");
        }
        if (page_of(module) == "abs" || page_of(module) == "ton" || page_of(module) == "toggle2nist" ||
            page_of(module) == "tristate_bit") {
            std::string shared = page_of(module);
            std::replace(shared.begin(), shared.end(), '_', '-');
            name.replace(0, name.find('.'), shared);
        }
        const bool present = std::any_of(words.begin(), words.end(),
                                         [&](const std::string &word) { return isNamed(word, name); });
        EXPECT_TRUE(present) << name << " is not in the page of " << module;
    };
    for (const hal::PinInfo &pin : bench.hal().pins().list("*")) {
        if (pin.owner == module && !pin.name.ends_with(".time")) {
            expect_named(pin.name);
        }
    }
    for (const hal::ParamInfo &param : bench.hal().params().list("*")) {
        if (param.owner == module && !param.name.ends_with(".tmax") &&
            !param.name.ends_with(".tmax-increased")) {
            expect_named(param.name);
        }
    }
    for (const hal::FunctionInfo &function : bench.hal().functions().list()) {
        if (function.owner == module) {
            expect_named(function.name);
        }
    }
}

std::vector<std::string> documented_modules() {
    std::vector<std::string> modules = all_modules();
    modules.insert(modules.end(), {"motmod", "tpmod", "homemod", "trivkins"});
    return modules;
}

INSTANTIATE_TEST_SUITE_P(All, ManPage, ::testing::ValuesIn(documented_modules()),
                         [](const auto &test) { return test.param; });

}  // namespace
}  // namespace mw::components::test
