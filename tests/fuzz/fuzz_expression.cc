// SPDX-License-Identifier: GPL-2.0-or-later
// One MDI line with the input as an expression.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "tests/fuzz/null_machine.hh"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    using namespace mw::gcode;
    mw::fuzz::NullMachine machine;
    MachineFrame frame(machine, LengthUnits::MM);
    Interpreter interpreter(frame, machine, machine, machine, {});
    if (!interpreter.begin()) {
        std::abort();
    }
    const std::string text(reinterpret_cast<const char *>(data), size);
    interpreter.execute("#1=3 #2=-1.5 #<a>=2 #<_g>=7");
    if (interpreter.execute("#100=[" + text + "]") == Step::FILE_END &&
        !std::isfinite(interpreter.parameter(100))) {
        std::abort();
    }
    return 0;
}
