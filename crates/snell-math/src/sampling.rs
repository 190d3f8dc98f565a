//! Well-distributed points and hashes.
