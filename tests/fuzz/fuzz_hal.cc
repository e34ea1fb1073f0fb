// SPDX-License-Identifier: GPL-2.0-or-later
// HAL files with an instance that has a component, functions and a thread. The first byte selects the meaning
// of the rest: text (lines, substitution, words), a list of commands with mostly valid words, or either of
// these in two passes. Completion is requested at the end.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "hal/core/host.hh"
#include "hal/script/commands.hh"
#include "hal/script/completion.hh"
#include "hal/script/session.hh"
#include "hal/script/two_pass.hh"
#include "runtime/virtual_scheduler.hh"

namespace {

using namespace mw::hal;

class NoOutput final : public script::Output {
  public:
    void data(std::string_view) override {}
    void info(std::string_view) override {}
    void note(std::string_view) override {}
    void warning(const mw::Error &) override {}
    void error(const mw::Error &) override {}
};

class Ini final : public script::IniLookup {
  public:
    std::optional<std::string> find(std::string_view section, std::string_view name) const override {
        return section == "S" ? std::optional<std::string>(std::string(name) + " b.in0") : std::nullopt;
    }
    std::vector<std::string> names(std::string_view) const override { return {"A", "B"}; }
};

constexpr std::string_view WORDS[] = {
    "b.in0",
    "b.in1",
    "b.out",
    "b.io",
    "b.value",
    "b.word",
    "b.gain",
    "b.read",
    "b.write",
    "t",
    "s0",
    "s1",
    "s2",
    "pin",
    "param",
    "sig",
    "comp",
    "funct",
    "thread",
    "alias",
    "all",
    "allu",
    "netl",
    "netla",
    "neta",
    "link",
    "linka",
    "sigu",
    "bit",
    "float",
    "s32",
    "u32",
    "s64",
    "u64",
    "port",
    "1",
    "0",
    "TRUE",
    "-1",
    "2.5",
    "0x10",
    "010",
    "-t",
    "-tbit",
    "*",
    "b.*",
    "[a-",
    "=>",
    "<=",
    "<=>",
    "=",
    "none",
    "tune",
    "lock",
    "mem",
    "names=a",
    "count=2",
    "-W",
    "-Wn",
    "-w",
    "\\\n",
    "#",
    "\"a b\"",
    "'c'",
    "$(HOME)",
    "[S]A",
    "[S](B)",
    "[S",
    "2",
    "-2",
    "99",
    "x",
    "personality=1,2",
    "names=a,b",
    "num_chan=1",
    "count=99999",
    "64",
    "\"",
};

/// One byte for a command, one for the number of its words, one for each word.
std::string made_of(const std::uint8_t *data, std::size_t size) {
    const auto commands = script::commands();
    std::string text;
    for (std::size_t i = 0; i + 1 < size;) {
        text += commands[data[i] % commands.size()].name;
        const std::size_t words = data[i + 1] % 6;
        i += 2;
        for (std::size_t w = 0; w < words && i < size; ++w, ++i) {
            text += ' ';
            text += WORDS[data[i] % std::size(WORDS)];
        }
        text += '\n';
    }
    return text;
}

void make_component(Instance &hal) {
    const int id = *hal.components().create("b", CompType::REALTIME);
    (void)hal.pins().create("b.in0", Type::BIT, Dir::IN, id);
    (void)hal.pins().create("b.in1", Type::BIT, Dir::IN, id);
    (void)hal.pins().create("b.out", Type::BIT, Dir::OUT, id);
    (void)hal.pins().create("b.io", Type::BIT, Dir::IO, id);
    (void)hal.pins().create("b.value", Type::FLOAT, Dir::IN, id);
    (void)hal.pins().create("b.word", Type::U32, Dir::IN, id);
    (void)hal.params().create("b.gain", Type::FLOAT, Dir::RW, hal.memory().allocate(8), id);
    (void)hal.functions().create("b.read", {[](void *, long) {}}, id);
    (void)hal.functions().create("b.write", {[](void *, long) {}}, id);
    (void)hal.components().set_ready(id);
    (void)hal.threads().create("t", 1000000);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    if (size == 0) {
        return 0;
    }
    const std::uint8_t mode = data[0];
    const std::string text = (mode & 1U) != 0
                                 ? made_of(data + 1, size - 1)
                                 : std::string(reinterpret_cast<const char *>(data) + 1, size - 1);
    mw::runtime::VirtualScheduler clock;
    InstanceOptions options;
    options.name = "fuzz";
    options.scheduler = &clock;
    auto host = LocalHost::create(options, {});
    if (!host) {
        return 0;
    }
    make_component((*host)->hal());
    script::InProcessProgramHost programs;
    NoOutput output;
    const Ini ini;
    script::MergedLoads loads;
    script::SessionOptions session_options;
    session_options.keepsGoing = true;
    session_options.has_placeholders = (mode & 4U) != 0;
    session_options.is_script = (mode & 8U) != 0;
    session_options.has_files = false;
    session_options.ini = &ini;
    script::Session session(**host, programs, output, session_options);
    if ((mode & 2U) != 0) {
        session.options().pass = script::Pass::LOADS;
        session.options().loads = &loads;
        (void)session.run_text(text, "fuzz");
        for (const auto &load : loads.loads()) {
            (void)load.words();
        }
        session.options().pass = script::Pass::REST;
    }
    (void)session.run_text(text, "fuzz");
    clock.run_until(2000000);
    const std::string last = text.substr(text.rfind('\n') + 1);
    if (last.find('/') == std::string::npos) {
        (void)script::completions(session, last);
    }
    return 0;
}
