// SPDX-License-Identifier: GPL-2.0-or-later
// vfdb_vfd [options]: a Delta VFD-B drive as pins of HAL (man page vfdb_vfd).
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/own_place.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "drivers/modbus/drives/kinds.hh"

namespace {

using mw::modbus::drives::Line;
using mw::modbus::drives::VfdbSettings;

/// Reads the keys of the drive's section and reports each error.
class Section {
  public:
    Section(const mw::ini::IniFile &file, std::string name, mw::diagnostics::Sink &sink)
        : file_(file), name_(std::move(name)), sink_(sink) {}

    void text(const char *key, std::string &into) const {
        if (const auto *entry = file_.find(name_, key)) {
            into = entry->value;
        }
    }
    void number(const char *key, double &into, double low, double high) const {
        const auto *entry = file_.find(name_, key);
        if (entry == nullptr) {
            return;
        }
        const auto value = mw::parse_double(entry->value);
        if (value.has_value() && *value >= low && *value <= high) {
            into = *value;
        } else {
            sink_.error("[" + name_ + "]" + key + " = " + entry->value + ": a number from " + shown(low) +
                            " to " + shown(high) + " is expected",
                        entry->place);
        }
    }
    void number(const char *key, int &into, int low, int high) const {
        double value = into;
        number(key, value, static_cast<double>(low), static_cast<double>(high));
        into = static_cast<int>(value);
    }
    void parity(char &into) const {
        const auto *entry = file_.find(name_, "PARITY");
        if (entry == nullptr) {
            return;
        }
        const char first = entry->value.empty()
                               ? '\0'
                               : static_cast<char>(std::toupper(static_cast<unsigned char>(entry->value[0])));
        if (first == 'E' || first == 'O' || first == 'N') {
            into = first;
        } else {
            sink_.error("[" + name_ + "]PARITY = " + entry->value + ": use Even, Odd or None", entry->place);
        }
    }

  private:
    static std::string shown(double value) {
        std::string text = std::to_string(value);
        text.erase(text.find_last_not_of('0') + 1);
        return text.ends_with('.') ? text.substr(0, text.size() - 1) : text;
    }

    const mw::ini::IniFile &file_;
    std::string name_;
    mw::diagnostics::Sink &sink_;
};

void read_section(const Section &section, Line &line, VfdbSettings &settings) {
    int shows = line.shown ? 1 : 0;
    section.text("DEVICE", line.device);
    section.number("BAUD", line.baud, 110, 115200);
    section.number("BITS", line.bits, 5, 8);
    section.number("STOPBITS", line.stop, 1, 2);
    section.parity(line.parity);
    section.number("TARGET", line.slave, 1, 254);
    section.number("POLLCYCLES", settings.poll_cycles, 1, 100000);
    section.number("MOTOR_HZ", settings.motor_hz, 1.0, 2000.0);
    section.number("MOTOR_RPM", settings.motor_rpm, 1.0, 1e6);
    section.number("MODBUS_DEBUG", shows, 0, 1000);
    line.shown = shows != 0;
}

}  // namespace

int main(int argc, char **argv) {
    mw::tell_when_memory_ends();
    Line line;
    VfdbSettings settings;
    const char *const machine = std::getenv("INI_FILE_NAME");
    std::string name = "vfdb_vfd", ini = machine != nullptr ? machine : "", section = "VFD-B";
    bool debugged = false, reported = false;
    mw::options::CommandLine options("loadusr -Wn NAME vfdb_vfd [OPTION ...]",
                                     "HAL pins for a Delta VFD-B drive on a serial line.");
    options.text("-n,--name", "NAME", "name of the component and its pins (vfdb_vfd)", name);
    options.text("-I,--ini", "FILE", "INI file of the settings (default: environment variable INI_FILE_NAME)",
                 ini);
    options.text("-S,--section", "NAME", "INI section of the settings (VFD-B)", section);
    options.flag("-m,--modbus-debug", "show all bytes", line.shown);
    options.flag("-d,--debug", "report the opened serial line", debugged);
    options.flag("-r,--report-device", "same as --debug", reported);
    const mw::options::Words words(argv + 1, argv + argc);
    if (mw::options::wantsHelp(words)) {
        std::fputs(options.help().c_str(), stdout);
        return 0;
    }
    if (const auto parsed = options.parse(words); !parsed) {
        mw::language::tell("vfdb_vfd", parsed.error());
        return 2;
    }
    mw::diagnostics::Sink sink(
        [](const mw::diagnostics::Diagnostic &found) { mw::language::tell(found.str()); });
    const auto file = mw::ini::IniFile::load(ini, sink);
    if (!file.has_value() || !file->hasSection(section)) {
        mw::language::tell("vfdb_vfd", file.has_value() ? mw::Error{ini + " has no section [" + section +
                                                                    "] with the settings of the drive"}
                                                        : file.error());
        return 1;
    }
    read_section(Section(*file, section, sink), line, settings);
    if (sink.hasErrors()) {
        return 1;
    }
    if (debugged || reported) {
        mw::language::tell(fmt::format("{}: {}, {} baud, parity {}, {} data bits, {} stop bits, drive {}",
                                       name, line.device, line.baud, line.parity, line.bits, line.stop,
                                       line.slave));
    }
    mw::catch_stop_signals();
    const auto drive = mw::modbus::drives::make_vfdb(settings);
    const auto done = mw::modbus::drives::run(*drive, name, line, mw::stop_signal);
    if (!done) {
        mw::language::tell("vfdb_vfd", done.error());
    }
    return done ? 0 : 1;
}
