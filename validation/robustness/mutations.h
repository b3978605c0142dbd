#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

/// Damage as strangers' models have it.
namespace robustness {

/// A damaged document and what was done to it, one line.
struct Mutant {
  std::string text;
  std::string story;
};

/// The XML document with one to three mutations: a number negative, zero, NaN, infinite, huge,
/// tiny, scaled, no number at all, or swapped with its neighbour; one number less or more in a
/// list; an element missing, doubled, swapped with its neighbour, emptied or renamed; a name
/// emptied, or that of another element; the texts of two elements swapped. Kinds of elements are
/// drawn alike, however many there are of each. The same seed makes the same mutant.
/// @throws std::invalid_argument if the text is not XML
Mutant mutated(const std::string& document, std::uint64_t seed);

}  // namespace robustness
