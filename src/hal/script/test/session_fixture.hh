// SPDX-License-Identifier: GPL-2.0-or-later
// A session in this process under the virtual clock, with its own component.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/script/session.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::hal::script {

class TextOutput final : public Output {
  public:
    void data(std::string_view text) override { answers += text; }
    void info(std::string_view text) override { infos += std::string(text) + "\n"; }
    void note(std::string_view text) override { notes += std::string(text) + "\n"; }
    void warning(const Error &warning) override { warnings += warning.str() + "\n"; }
    void error(const Error &error) override { errors += error.str() + "\n"; }

    std::string answers, infos, notes, warnings, errors;
};

class SessionTest : public ::testing::Test {
  protected:
    SessionTest() {
        InstanceOptions hal_options;
        hal_options.name = "session-test";
        hal_options.scheduler = &clock;
        host = std::move(*LocalHost::create(hal_options));
        // This test has its own pins, because components of other folders are not built for it.
        const int id = *host->hal().components().create("board");
        for (const char *name : {"board.in0", "board.in1", "board.io"}) {
            slots.push_back(*host->hal().pins().create(
                name, Type::BIT, name[6] == 'i' && name[7] == 'o' ? Dir::IO : Dir::IN, id));
        }
        slots.push_back(*host->hal().pins().create("board.out", Type::BIT, Dir::OUT, id));
        slots.push_back(*host->hal().pins().create("board.value", Type::FLOAT, Dir::IN, id));
        slots.push_back(*host->hal().pins().create("board.word", Type::U32, Dir::IN, id));
        gain = host->hal().memory().allocate(8);
        EXPECT_TRUE(host->hal().params().create("board.gain", Type::FLOAT, Dir::RW, gain, id));
        EXPECT_TRUE(host->hal().components().set_ready(id));
    }

    /// Runs lines; returns the results, or the errors if there are any.
    std::string run(const std::string &text) {
        TextOutput out;
        Session session(*host, programs, out, options);
        last_result = session.run_text(text, "test.hal");
        left_out = session.left_out();
        output = out;
        return out.errors.empty() ? out.answers : out.errors;
    }

    runtime::VirtualScheduler clock;
    std::unique_ptr<LocalHost> host;
    InProcessProgramHost programs;
    SessionOptions options;
    TextOutput output;
    Result<> last_result;
    std::vector<std::string> left_out;
    std::vector<void **> slots;
    void *gain = nullptr;
};

}  // namespace mw::hal::script
