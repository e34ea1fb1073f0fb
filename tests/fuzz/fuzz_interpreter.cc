// SPDX-License-Identifier: GPL-2.0-or-later
// Complete programs: no text may cause a crash, a hang or an access outside memory bounds.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "tests/fuzz/null_machine.hh"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    using namespace mw::gcode;
    mw::fuzz::NullMachine machine;
    MachineFrame frame(machine, LengthUnits::MM);
    Settings settings;
    settings.statement_budget = 500;
    settings.remaps = {"M400 modalgroup=5 argspec=Pq ngc=400", "G88.1 modalgroup=1 argspec=@XYzp ngc=88"};
    Interpreter interpreter(frame, machine, machine, machine, settings);
    if (!interpreter.begin()) {
        std::abort();
    }
    interpreter.open_text("fuzz.ngc", std::string(reinterpret_cast<const char *>(data), size));
    constexpr int MAX_STEPS = 1000;
    for (int i = 0; i < MAX_STEPS; ++i) {
        const Step step = interpreter.step();
        if (step == Step::SYNC) {
            interpreter.synch();
        } else if (step == Step::PROGRAM_END || step == Step::FILE_END ||
                   (step == Step::FAILED && interpreter.isAtFileEnd())) {
            break;
        }
    }
    return 0;
}
