// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/doctor/hal_files.hh"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "machine/assembly/machine.hh"
#include "machine/config/loaded_config.hh"

namespace mw::doctor {
namespace {

/// Output of commands in HAL files is not a finding.
class NoOutput {
  public:
    NoOutput() {
        std::fflush(stdout);
        before_ = ::dup(STDOUT_FILENO);
        const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
        ::dup2(nothing, STDOUT_FILENO);
        ::close(nothing);
    }
    NoOutput(const NoOutput &) = delete;
    NoOutput &operator=(const NoOutput &) = delete;
    ~NoOutput() {
        std::fflush(stdout);
        ::dup2(before_, STDOUT_FILENO);
        ::close(before_);
    }

  private:
    int before_ = -1;
};

/// The text between the first two quotes of a message.
std::string quoted(const std::string &message) {
    const auto first = message.find('\'');
    const auto end = first == std::string::npos ? first : message.find('\'', first + 1);
    return end == std::string::npos ? std::string() : message.substr(first + 1, end - first - 1);
}

/// Filters messages about missing pins and functions of a module that was not loaded.
class Consequences {
  public:
    bool isOne(const diagnostics::Diagnostic &finding) {
        const std::string name = quoted(finding.what.message);
        if (finding.what.message.starts_with("there is no module ") ||
            finding.what.message.starts_with("module '")) {
            std::string module = name.ends_with(".so") ? name.substr(0, name.size() - 3) : name;
            module = module.starts_with("hal_") ? module.substr(4) : module;
            // hm2_pci makes hm2_5i25.0.read, classicladder_rt makes classicladder.0.in-00
            modules_.push_back(module.substr(0, module.find('_')));
            return false;
        }
        const bool missing = finding.what.message.ends_with("does not exist");
        const bool follows = missing && std::ranges::any_of(modules_, [&name](const std::string &module) {
                                 return name.starts_with(module + '.') || name.starts_with(module + '_');
                             });
        count_ += follows ? 1 : 0;
        return follows;
    }
    int count() const { return count_; }

  private:
    std::vector<std::string> modules_;
    int count_ = 0;
};

}  // namespace

void examine_hal_files(ini::IniFile ini, diagnostics::Sink &sink) {
    const NoOutput quiet;
    const std::string path = ini.path();
    Consequences consequences;
    diagnostics::Sink unheard;
    machine::LoadedConfig loaded(std::move(ini), unheard);  // its own findings have been reported
    diagnostics::Sink heard([&](const diagnostics::Diagnostic &found) {
        diagnostics::Diagnostic finding = found;
        if (finding.what.place.file.empty()) {
            finding.what.place.file = path;
        }
        if (!consequences.isOne(finding)) {
            sink.report(std::move(finding));
        }
    });
    loaded.reader.tell(heard);
    machine::MachineOptions options;
    options.kept_going = true;
    const auto made =
        machine::make_virtual_machine({loaded.ini, loaded.reader, loaded.machine, heard}, options);
    if (!made.has_value()) {
        heard.failure(made.error());
    }
    if (consequences.count() > 0) {
        sink.note(fmt::format("{} more lines name pins and functions of the modules that are missing",
                              consequences.count()),
                  {path, 0, 0});
    }
}

}  // namespace mw::doctor
