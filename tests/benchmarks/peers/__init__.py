"""The contenders: ``python -m tests.benchmarks.peers.NAME FILE`` writes a picture of a sphere, and ends.

``frames(variant)`` gives a function that draws frame n of the large sphere and returns it as an array.
"""
