float radius(float share, float decades) { return share > 0.0 ? max(1.0 + log2(share) / (decades * 3.32192809), 0.0) : 0.0; }
