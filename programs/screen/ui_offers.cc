// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/screen/ui_offers.hh"

#include "clients/publish/assembly/settings.hh"

namespace mw::programs {

std::string offers_folder(const ini::IniFile &ini) {
    diagnostics::Sink silent([](const diagnostics::Diagnostic &) {});
    if (!ini.hasSection("PUBLISH")) {
        return "";
    }
    const auto settings = publish::read_settings(ini, publish::this_computer(), silent);
    return settings.has_value() && settings->offers.has_value() ? settings->offers_folder() : "";
}

}  // namespace mw::programs
