//! Pages in all three formats against each other and against independent viewers.
