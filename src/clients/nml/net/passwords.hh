// SPDX-License-Identifier: GPL-2.0-or-later
// Password files: a line "name:password" for each user; # begins a comment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::nml {

struct Credentials {
    std::string name;
    std::string password;
};

class Passwords {
  public:
    /// An error when the file cannot be read, others than its owner may read it, or a line is wrong.
    static Result<Passwords> load(const std::string &path);

    /// Takes the same time for each wrong password.
    bool isRight(std::string_view name, std::string_view password) const;
    /// What a client says of itself: the first line.
    const Credentials &first() const { return users_.front(); }

  private:
    std::vector<Credentials> users_;  ///< at least one
};

}  // namespace mw::nml
