// SPDX-License-Identifier: GPL-2.0-or-later
// Arbitrary text as a HAL file: lines, substitution, words and commands against an instance without modules.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hal/core/host.hh"
#include "hal/lang/session.hh"
#include "rtapi/virtual_scheduler.hh"

namespace {

class NoOutput final : public mw::hal::lang::Output {
  public:
    void data(std::string_view) override {}
    void info(std::string_view) override {}
    void note(std::string_view) override {}
    void warning(const mw::Error &) override {}
    void error(const mw::Error &) override {}
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char *>(data), size);
    // `save KIND FILE` writes where it is told to; everything else stays in memory.
    if (text.find("save") != std::string_view::npos) {
        return 0;
    }
    mw::rtapi::VirtualScheduler clock;
    mw::hal::HalOptions options;
    options.name = "fuzz";
    options.scheduler = &clock;
    auto host = mw::hal::LocalHost::create(options, {});
    if (!host) {
        return 0;
    }
    mw::hal::lang::InProcessProgramHost programs;
    NoOutput output;
    mw::hal::lang::SessionOptions session_options;
    session_options.keepsGoing = true;
    session_options.hasPlaceholders = true;
    mw::hal::lang::Session session(**host, programs, output, session_options);
    (void)session.run_text(text, "fuzz");
    return 0;
}
