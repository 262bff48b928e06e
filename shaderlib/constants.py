"""Constants shared by the shading functions; each is used as the nearest float32."""

PI = 3.14159265358979324
TWO_PI = 6.28318530717958648
HALF_PI = 1.57079632679489662
QUARTER_PI = 0.785398163397448310
INV_PI = 0.318309886183790672
INV_TWO_PI = 0.159154943091895336

# exp is evaluated on [-80, 80] only. e^-80 = 1.8e-35 and e^80 = 5.5e34 are ordinary float32 numbers;
# e^-88 is a denormal, which is slow on some drivers and flushed to zero on others.
EXP_LIMIT = 80.0

# Smallest squared length that is divided by. Every term of a squared length may flush to zero below
# 1.18e-38, so a sum above 1e-37 cannot be all noise.
TINY_SQUARE = 1.0e-37

# Smallest argument of log and smallest divisor: the first round number above the float32 denormals.
SMALLEST_NORMAL = 1.2e-38

# The largest float32 below 1.
ONE_BELOW = 0.99999994

# Paths and extinctions saturate here: the product of two of them, 1e36, is still finite.
COAT_LIMIT = 1.0e18
