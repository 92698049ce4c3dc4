#include "fast/certified/nearest_parameters.hpp"

#include <gtest/gtest.h>
