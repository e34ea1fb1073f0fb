// SPDX-License-Identifier: GPL-2.0-or-later
// Programs that a shop offers to this machine. A person at a screen accepts or declines them.
#pragma once

#include <string>

#include "clients/offers/offer_box.hh"
#include "clients/screen/files/files.hh"
#include "clients/screen/http/http_types.hh"

namespace mw::screen {

/// What the machine does with programs now.
struct ProgramUse {
    bool isRunning = false;  ///< a program runs or is paused
    std::string open;        ///< path of the open program; empty: none
};

/// Blocks during disk access. One thread at a time.
class OfferedPrograms {
  public:
    /// `folder` is that of an OfferBox; empty: this machine receives no offers.
    OfferedPrograms(std::string folder, ProgramFiles &files) : folder_(std::move(folder)), files_(files) {}

    /// {"enabled": true, "offers": [...]}: offers that wait, accepted jobs, and offers that ended lately.
    Response list() const;
    /// The offer with its text.
    Response read(const std::string &id) const;
    /// {"decision": "accept" | "decline" | "finish", "by": "NAME", "reason": "", "replace": false}. Accepting
    /// writes the files into the folder of programs, and nothing else: no program is opened or started.
    /// Without "replace" no file with another content is replaced: 409 {"error": "...", "replaces":
    /// ["NAME"]}. A replaced file is kept as NAME~. While a program runs nothing is accepted, and the open
    /// program is not replaced.
    Response decide(const std::string &id, const std::string &body, const Requester &by,
                    const ProgramUse &use);

  private:
    struct Decision {
        std::string decision, by, reason;
        bool isReplacing = false;
    };
    static Result<Decision> read_decision(const std::string &body);
    Response accept(offers::OfferBox &box, const std::string &id, const Decision &decision,
                    const ProgramUse &use);
    Result<std::vector<std::string>> replaced(const offers::Offer &offer, const ProgramUse &use) const;

    std::string folder_;
    ProgramFiles &files_;
};

}  // namespace mw::screen
