"""Certificates: periodic orbits, bifurcations and chaos of the vertical motion, proved by interval arithmetic.

Every number is a ball of python-flint (Johansson 2017): a centre and a radius that hold the exact value, all rounding
included. What cannot be proved raises `Refused` with the reason. The float side of the library only says where to look;
no bound depends on it.

    law       the conveyor in units g/ω², g/ω, 1/ω, its numbers read as the decimals that are written
    balls     conversions, rounded outwards
    roots     the first zero of a function: existence, uniqueness, and nothing before it
    taylor    one Taylor step of the contact with a proved remainder, and its derivative
    suggestion  its coefficients in compiled arithmetic, which `taylor` proves
    flight    parabola and harmonic plate, in closed form
    motion    the motion from one phase to another through flights and contacts, and its derivative
    guess     an orbit in floating point, where proofs begin
    newton    Krawczyk's operator
    orbit     a periodic orbit: existence, uniqueness, least period, stability
    brackets  amplitudes between which an orbit folds or doubles
    covering  topological horseshoes
"""
