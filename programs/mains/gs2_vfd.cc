// SPDX-License-Identifier: GPL-2.0-or-later
// gs2_vfd [options]: an AutomationDirect GS2 drive as pins of HAL (man page gs2_vfd).
#include <cctype>
#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/own_place.hh"
#include "base/stop_signals.hh"
#include "drivers/modbus/drives/kinds.hh"

namespace {

using mw::Result;

Result<> read_parity(const mw::options::Words &words, char &into) {
    const auto first =
        words[0].empty() ? '\0' : static_cast<char>(std::toupper(static_cast<unsigned char>(words[0][0])));
    if (first != 'E' && first != 'O' && first != 'N') {
        return mw::fail("'" + words[0] + "' is not a parity: use even, odd or none");
    }
    into = first;
    return {};
}

}  // namespace

int main(int argc, char **argv) {
    mw::tell_when_memory_ends();
    mw::modbus::drives::Line line{.baud = 38400, .parity = 'O'};
    mw::modbus::drives::Gs2Settings settings;
    std::string name = "gs2_vfd";
    bool verbose = false;
    mw::options::CommandLine options("loadusr -Wn NAME gs2_vfd [OPTION ...]",
                                     "HAL pins for an AutomationDirect GS2 drive on a serial line.");
    constexpr double MAX_S = 600.0;
    options.text("-d,--device", "FILE", "the serial line (/dev/ttyS0)", line.device);
    options.number("-r,--rate", "BAUD", "baud rate (38400)", line.baud, 110, 115200);
    options.number("-b,--bits", "N", "data bits (8)", line.bits, 5, 8);
    options.number("-s,--stopbits", "N", "stop bits (1)", line.stop, 1, 2);
    options.take("-p,--parity", 1, "even|odd|none", "parity of the line (odd)",
                 [&](const mw::options::Words &words) { return read_parity(words, line.parity); });
    options.number("-t,--target", "N", "slave address of the drive (1)", line.slave, 1, 254);
    options.text("-n,--name", "NAME", "name of the component and its pins (gs2_vfd)", name);
    options.number("-A,--accel-seconds", "S", "acceleration time to maximum speed (10)", settings.accel_s,
                   0.1, MAX_S);
    options.number("-D,--decel-seconds", "S", "deceleration time from maximum speed; 0: the motor coasts (0)",
                   settings.decel_s, 0.0, MAX_S);
    options.flag("-R,--braking-resistor", "a braking resistor is fitted: the drive brakes at any voltage",
                 settings.has_braking_resistor);
    options.flag("-g,--debug", "show all bytes", line.shown);
    options.flag("-v,--verbose", "report the opened serial line", verbose);
    const mw::options::Words words(argv + 1, argv + argc);
    if (mw::options::wantsHelp(words)) {
        std::fputs(options.help().c_str(), stdout);
        return 0;
    }
    if (const Result<> parsed = options.parse(words); !parsed) {
        mw::language::tell("gs2_vfd", parsed.error());
        return 2;
    }
    if (verbose) {
        mw::language::tell(fmt::format("{}: {}, {} baud, parity {}, {} data bits, {} stop bits, drive {}",
                                       name, line.device, line.baud, line.parity, line.bits, line.stop,
                                       line.slave));
    }
    mw::catch_stop_signals();
    const auto drive = mw::modbus::drives::make_gs2(settings);
    const Result<> done = mw::modbus::drives::run(*drive, name, line, mw::stop_signal);
    if (!done) {
        mw::language::tell("gs2_vfd", done.error());
    }
    return done ? 0 : 1;
}
