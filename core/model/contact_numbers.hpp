#pragma once

#include <string>

#include <barchan/core/model/model.hpp>

namespace barchan {

/// Sets one number of a pair of materials under the key that a deck has for it: friction,
/// normal_stiffness and so on, or restitution, which gives the dashpot that rebounds so.
/// @param contacts  the law that reads the pair
/// Errors: InputError: a key that this law does not have, or that is of one material alone
void set_number(const ContactTable& contacts, ContactConstants& pair, const std::string& key,
                double value);

}  // namespace barchan
