// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>

#include "drivers/mesa/hostmot2/modules/factories.hh"

namespace mw::mesa {

namespace {

struct Factory {
    Gtag gtag;
    std::unique_ptr<Module> (*make)(const ModuleRequest &);
};

constexpr Factory FACTORIES[] = {
    {Gtag::STEPGEN, make_stepgens},
    {Gtag::ENCODER, make_encoders},
    {Gtag::MUXED_ENCODER, make_encoders},
    {Gtag::PWM, make_pwmgens},
    {Gtag::LED, make_leds},
    {Gtag::SSR, make_ssrs},
    {Gtag::DPLL, make_dpll},
    {Gtag::OUT_M, make_outms},
    {Gtag::IN_MUX, make_inmuxs},
    {Gtag::IN_M, make_inms},
    {Gtag::THREE_PHASE_PWM, make_three_phase_pwms},
    {Gtag::RC_PWM, make_rc_pwms},
    {Gtag::RESOLVER, make_resolvers},
    {Gtag::SMART_SERIAL, make_sserial},
    {Gtag::SMART_SERIAL_B, make_sserial},
    {Gtag::UART_TX, make_uarts},
    {Gtag::PKT_UART_TX, make_packet_uarts},
    {Gtag::BSPI, make_bspis},
    {Gtag::SSI, make_absolute_encoders},
    {Gtag::BISS, make_absolute_encoders},
    {Gtag::FANUC_ABSOLUTE, make_absolute_encoders},
    {Gtag::XY2_100, make_galvanometers},
    {Gtag::ONE_SHOT, make_one_shots},
    {Gtag::PERIOD_METER, make_period_meters},
};

}  // namespace

std::unique_ptr<Module> make_module(const ModuleRequest &request) {
    const auto *factory = std::ranges::find(FACTORIES, request.module.descriptor.gtag, &Factory::gtag);
    return factory == std::end(FACTORIES) ? nullptr : factory->make(request);
}

const UsedModule *find_module(const Assignment &assignment, Gtag gtag) noexcept {
    const auto found = std::ranges::find_if(
        assignment.modules, [&](const UsedModule &module) { return module.descriptor.gtag == gtag; });
    return found == assignment.modules.end() ? nullptr : &*found;
}

bool hasDpll(const Assignment &assignment) noexcept {
    return std::ranges::any_of(assignment.modules, [](const UsedModule &module) {
        return module.descriptor.gtag == Gtag::DPLL && module.instances > 0;
    });
}

}  // namespace mw::mesa
