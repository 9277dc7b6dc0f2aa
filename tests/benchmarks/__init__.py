"""How fast Demoscope is, beside other viewers on the same machine in the same run: ``make bench``.

    python -m tests.benchmarks                      every subject
    python -m tests.benchmarks panels --rounds 3    one of them, quickly

Contenders take turns, so that whatever else the machine is doing troubles them alike; each figure is the
median over all rounds, with the best beside it.
"""
