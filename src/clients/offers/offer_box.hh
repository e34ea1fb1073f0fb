// SPDX-License-Identifier: GPL-2.0-or-later
// The offers of a machine on its disk: a folder that `millwright publish` fills and the screen shows.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "clients/offers/exchange.hh"

namespace mw::offers {

/// An offer without its text.
struct Entry {
    std::string name{}, from{}, note{}, sha256{};
    int parts = 0;
    std::uint64_t bytes = 0;
    std::vector<std::string> files{};
    TimeMs received = 0;
    Standing standing{};        ///< with the id
    State noted = State::SENT;  ///< the state that the shop has stored
    bool isJob = false;         ///< accepted with a number of parts, and not finished

    bool isNoted() const { return noted == standing.state; }
    bool operator==(const Entry &) const = default;
};

/// Several processes may use one folder: each call locks it, and replaces files atomically. The text of an
/// offer is the file ID.json, the states of all offers are the file index. Errors name the file and the
/// reason; after an error the folder is as before.
class OfferBox {
  public:
    /// Number of offers that may wait for the operator.
    static constexpr std::size_t MOST_OPEN = 50;
    /// Number of ended offers whose ids are known, so that they are not received again.
    static constexpr std::size_t MOST_ENDED = 1000;

    /// Creates the folder if it is missing. Removes texts that an interrupted call has left.
    static Result<OfferBox> open(const std::string &folder);

    /// Stores an offer that waits for the operator. A known id has no effect; with another content it is an
    /// error.
    Result<> take(const Offer &offer, TimeMs now);
    /// An offer that broke a rule was received.
    Result<> reject(const BrokenOffer &broken, TimeMs now);
    /// Offers that are accepted or declined stay so. Unknown ids count as withdrawn from now on.
    Result<> withdraw(const std::vector<std::string> &ids, TimeMs now);
    Result<> note(const std::vector<Note> &notes);

    /// Calls `put` with the offer, which writes its files; then the offer is accepted. After an error of
    /// `put` the offer waits as before. The folder is locked until then, so an offer cannot be withdrawn
    /// meanwhile.
    Result<> accept(const std::string &id, const std::string &by, TimeMs now,
                    const std::function<Result<>(const Offer &)> &put);
    Result<> decline(const std::string &id, const std::string &by, const std::string &reason, TimeMs now);
    /// Removes the job of an accepted offer from the list.
    Result<> finish(const std::string &id);

    /// In the order of arrival.
    Result<std::vector<Entry>> entries() const;
    /// An offer that waits.
    Result<Offer> read(const std::string &id) const;
    /// Changes when the index changes; 0: there is none.
    std::uint64_t version() const;

  private:
    explicit OfferBox(std::string folder) : folder_(std::move(folder)) {}
    using Change = std::function<Result<>(std::vector<Entry> &)>;
    Result<> change(const Change &act);
    Result<std::vector<Entry>> load() const;
    Result<> save(const std::vector<Entry> &entries) const;
    void tidy(const std::vector<Entry> &entries) const;
    std::string text_file(const std::string &id) const { return folder_ + '/' + id + ".json"; }
    std::string index_file() const { return folder_ + "/index"; }

    std::string folder_;
};

/// The report of these offers to the shop.
Report report_of(const std::vector<Entry> &entries);

}  // namespace mw::offers
