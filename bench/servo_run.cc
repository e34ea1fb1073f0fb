// SPDX-License-Identifier: GPL-2.0-or-later
// Runs a complete machine in virtual time without a trace: `servo_run MACHINE.ini PROGRAM.ngc`.
// bench/servo_instructions.py counts its instructions.
#include <cstdio>
#include <cstdlib>

#include "machine/assembly/machine.hh"
#include "machine/config/loaded_config.hh"
#include "programs/run/run_session.hh"

namespace {

mw::Result<> run(const char *ini, const char *program, mw::diagnostics::Sink &sink) {
    const auto loaded = mw::machine::LoadedConfig::load(ini, sink);
    if (loaded == nullptr) {
        return mw::fail("the configuration has errors");
    }
    loaded->machine.task.parameter_file.clear();
    const mw::machine::MachineParts parts{loaded->ini, loaded->reader, loaded->machine, sink};
    auto machine = mw::machine::make_virtual_machine(parts, {});
    if (!machine.has_value()) {
        return std::unexpected(machine.error());
    }
    mw::programs::OwnMachine own(**machine);
    mw::programs::RunSession person(own, loaded->machine, sink, {});
    auto status = person.switch_on();
    status = status.has_value() ? person.home_all() : status;
    status = status.has_value() ? person.open_program(program) : status;
    status = status.has_value() ? person.run_program(1, [] {}) : status;
    person.switch_off();
    return status;
}

}  // namespace

int main(int argc, char **argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: servo_run MACHINE.ini PROGRAM.ngc\n");
        return 2;
    }
    ::setenv("MILLWRIGHT_MODULE_PATH", MW_LIB_DIR, 0);
    mw::diagnostics::Sink sink;
    const auto status = run(argv[1], argv[2], sink);
    if (!status.has_value()) {
        std::fprintf(stderr, "servo_run: %s\n", status.error().message.c_str());
        return 1;
    }
    return 0;
}
