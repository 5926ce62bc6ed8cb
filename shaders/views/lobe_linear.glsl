float radius(float share, float decades) { return share; }
