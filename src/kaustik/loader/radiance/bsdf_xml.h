#pragma once
#include <optional>
#include <string>

namespace kaustik::radiance {

/// How much of even light a measured layer throws back and lets through.
struct BsdfShares {
  double reflected = 0, transmitted = 0;
};

/// Of a file of WINDOW's XML with matrices over Klems' angles (Klems, "A New Method for Predicting
/// the Solar Heat Gain of Complex Fenestration Systems", ASHRAE Transactions 100, 1994), for the
/// visible light at its front. Nothing where it holds no such matrix.
std::optional<BsdfShares> read_bsdf_shares(const std::string& text);

}  // namespace kaustik::radiance
