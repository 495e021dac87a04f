// Saved games: a world with all that is in it, its structure too, as a document without addresses, that
// another process loads.
//
// After loading the world runs on as the one that was saved does, to the bit on the same platform: bodies,
// stock joints, contacts with their impulses and the broad phase are as they were, and the joints of the
// structure with what they have been through. Listeners, filters and handlers are the game's, and so is what
// its user data point to: they are saved as the numbers that they are.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/joint.h"

namespace ductile {

/// The structure's world as CBOR (RFC 8949): the document that save_json() writes, in fewer bytes.
/// Changes nothing in the world. Throws std::logic_error while the world is stepping, where the last step was
/// not followed by Structure::update(), and where the world has a second structure or is gone.
std::vector<std::uint8_t> save_bytes(const Structure& structure);
std::string save_json(const Structure& structure);

/// Into the world of a structure that has no bodies and joints yet. Bodies and joints come in the order of
/// the saved world's lists, and joints of the structure have their id(). Settings of world and structure are
/// the saved ones. Throws std::logic_error where the world has bodies, is stepping or is gone, and
/// std::invalid_argument where the document is not a save or says what cannot be, naming the place: then the
/// world has no bodies. What another version of ductile says of the solver's own past is left out: the world
/// goes on from the same poses, velocities and strains, but not to the bit.
void load_bytes(Structure& structure, std::span<const std::uint8_t> bytes);
void load_json(Structure& structure, std::string_view text);

}  // namespace ductile
