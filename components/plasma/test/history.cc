// SPDX-License-Identifier: GPL-2.0-or-later
// plasmac_history: prints the outputs of our controller for a history of inputs, for script/compare plasmac.
//
//     plasmac_history SCRIPT INPUTS OUTPUTS
//
// SCRIPT has lines "set PIN VALUE" (before the first cycle), "at CYCLE PIN VALUE" in the order of cycles, and
// "cycles N". PIN may be material, volts or z0 of the simulated table, no-float, no-volts, no-sideways to
// drive those inputs by the script, program for a user interface that answers program-pause, or pause and
// resume. INPUTS gets every input of each cycle, OUTPUTS every output, in the order of the tables of pins.
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "components/plasma/test/table.hh"

namespace {
using namespace mw::plasma;

struct Event {
    long cycle;
    std::string pin;
    double value;
};

void apply(test::Table &table, const std::string &pin, double value) {
    if (pin == "material") {
        table.material_mu = value;
    } else if (pin == "volts") {
        table.volts = value;
    } else if (pin == "z0") {
        table.z0_mu = value;
    } else if (pin == "program") {
        table.has_program = true;
    } else if (pin == "pause") {
        table.pause();
    } else if (pin == "resume") {
        table.resume();
    } else if (pin == "no-float") {
        table.has_float = false;
    } else if (pin == "no-volts") {
        table.has_volts = false;
    } else if (pin == "no-sideways") {
        table.has_sideways = false;
    } else if (!test::set_input(table.in, pin, value)) {
        std::fprintf(stderr, "no input %s\n", pin.c_str());
    }
}

void print_inputs(std::FILE *file, const Inputs &in) {
    mw::sdk::for_each_pin(INPUT_PINS, [&](const char *, const auto &row) {
        std::fprintf(file, "%.17g ", static_cast<double>(in.*(row.read.member)));
    });
    std::fputc('\n', file);
}

void print_outputs(std::FILE *file, const Outputs &out) {
    mw::sdk::for_each_pin(OUTPUT_PINS, [&](const char *, const auto &row) {
        std::fprintf(file, "%.9f ", static_cast<double>(row.write(out)));
    });
    std::fputc('\n', file);
}
}  // namespace

int main(int argc, char **argv) {
    if (argc != 4) {
        std::fprintf(stderr, "plasmac_history SCRIPT INPUTS OUTPUTS\n");
        return 2;
    }
    test::Table table;
    std::vector<Event> events;
    long cycles = 0;
    std::ifstream script(argv[1]);
    for (std::string word; script >> word;) {
        Event event{-1, "", 0.0};
        if (word == "cycles") {
            script >> cycles;
            continue;
        }
        if (word == "at") {
            script >> event.cycle;
        }
        script >> event.pin >> event.value;
        events.push_back(event);
    }
    std::FILE *inputs = std::fopen(argv[2], "w");
    std::FILE *outputs = std::fopen(argv[3], "w");
    if (inputs == nullptr || outputs == nullptr) {
        std::perror("plasmac_history");
        return 1;
    }
    std::size_t next = 0;
    for (long cycle = 0; cycle < cycles; ++cycle) {
        for (; next < events.size() && events[next].cycle <= cycle; ++next) {
            apply(table, events[next].pin, events[next].value);
        }
        table.cycle();
        print_inputs(inputs, table.in);
        print_outputs(outputs, table.out());
    }
    std::fclose(inputs);
    std::fclose(outputs);
    return 0;
}
