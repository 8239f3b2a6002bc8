"""The kinds `structure` (mobility, Assur groups and class from links and pairs) and `synthesis` (lengths from extreme
positions).
"""
