#include "bio/skeleton/tree_energy.h"

#include "bio/skeleton/tree_energy_bodies.h"

namespace bio {

template class TreeEnergy<1, double>;
template class TreeEnergy<Eigen::Dynamic, double>;

}  // namespace bio
